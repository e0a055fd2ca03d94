"""The alternative that always finds the best gait: scipy's differential evolution.

As a user with numpy and scipy writes it: the population is one array of gaits whose steady
cycles are solved at once; every limit that can be a bound is one; the torque is a penalty
during the search. A search on few nodes is enough to find the basin; the best member is then
polished by SLSQP, with the torque as a constraint, doubling the nodes until the speed holds.

`python -m benchmarks.optimise.differential_evolution [PROBLEM ...]`
"""

from __future__ import annotations

import json
import sys
import time
from dataclasses import asdict, dataclass

import numpy as np
from scipy import optimize

from benchmarks.optimise.fourier_numpy import Array
from benchmarks.optimise.polish import polish
from benchmarks.optimise.problems import PROBLEMS
from benchmarks.optimise.space import Box, Gait
from rr_opt.model.problem import Problem

PENALTY = 10.0  # m/s for each time the torque exceeds its limit
RESOLVED = 1e-6  # of the speed
MOST_NODES = 1024


@dataclass(frozen=True)
class Answer:
    """The best gait found, and what it took: CPU seconds and steady cycles."""

    gait: Gait
    point: list[float]
    feasible: bool
    seconds: float
    evaluations: int
    nodes: int


def search(box: Box, nodes: int, seed: int, popsize: int, tol: float) -> tuple[Array, int]:
    """The best member of the last population, and the cycles solved on the way."""
    limit, count = box.problem.limits.torque, 0

    def cost(X: Array) -> Array:
        nonlocal count
        count += X.shape[1]
        gain, done = box.performance(X.T, nodes)
        return PENALTY * np.nan_to_num(np.maximum(done.torque / limit - 1, 0.0)) - gain

    found = optimize.differential_evolution(
        cost,
        box.bounds,
        vectorized=True,
        updating="deferred",
        popsize=popsize,
        tol=tol,
        polish=False,
        rng=seed,
    )
    return found.x, count


def solve(
    problem: Problem, seed: int = 0, *, nodes: int = 64, popsize: int = 15, tol: float = 1e-2
) -> Answer:
    """The fastest gait of `problem`, its speed resolved to 1e-6."""
    begin = time.process_time()
    box = Box(problem)
    x, evaluations = search(box, nodes, seed, popsize, tol)
    x, count = polish(box, x, nodes)
    evaluations += count
    gait = box.gait(x, nodes)
    while nodes < MOST_NODES:
        finer = box.gait(x, 2 * nodes)
        if abs(finer.speed - gait.speed) <= RESOLVED * abs(finer.speed):
            break
        nodes *= 2
        x, count = polish(box, x, nodes)
        evaluations += count
        gait = box.gait(x, nodes)
    gain, _ = box.performance(x[None], nodes)
    feasible = gain[0] >= 0 and not gait.torque > problem.limits.torque * (1 + 1e-6)
    return Answer(gait, x.tolist(), bool(feasible), time.process_time() - begin, evaluations, nodes)


def main(names: list[str]) -> None:
    for name in names or PROBLEMS:
        answer = solve(PROBLEMS[name])
        print(json.dumps({"problem": name, **asdict(answer)}))


if __name__ == "__main__":
    main(sys.argv[1:])
