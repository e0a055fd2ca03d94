"""The best known gait of every problem, by a search too slow for anything but a benchmark.

A quarter of a million quasi-random gaits, half of them on edges of the box; the best of every
region polished by SLSQP; the winners polished again on more nodes until the speed holds to
1e-10; then a shrinking cloud of gaits around the winner, which knows no derivative, has to find
nothing better. Differential evolution runs too, and the better of the two is kept. Last, the
winner is replayed by integrating other equations of motion.

`python -m benchmarks.optimise.brute_force [PROBLEM ...]` rewrites best_known.json.
"""

from __future__ import annotations

import json
import math
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy.stats import qmc

from benchmarks.optimise import check_fourier, differential_evolution
from benchmarks.optimise.fourier_numpy import Array, peaks
from benchmarks.optimise.polish import polish
from benchmarks.optimise.problems import PROBLEMS
from benchmarks.optimise.space import Box, Gait
from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.problem import Problem

STORE = Path(__file__).with_name("best_known.json")
POINTS, CHUNK = 2**18, 2**12
BEST, APART, SPREAD = 40, 0.08, 24  # starts: the best of each region, and some from anywhere
COARSE, FINE = {"nodes": 96, "finer": 4}, {"nodes": 256, "finer": 16}
TORQUE_SLACK = 1e-8  # of the limit


def score(box: Box, X: Array, slack: float = TORQUE_SLACK, **how: int) -> Array:
    """Gain (m/s) of the points X; -inf where the torque exceeds its limit by more than slack."""
    gain, done = box.performance(X, **how)
    heavy = done.torque > box.problem.limits.torque * (1 + slack)
    return np.where(heavy | ~np.isfinite(gain), -np.inf, gain)


def starts(box: Box, points: int, seed: int = 0) -> Array:
    """The best points of a Sobol set, no two in one region; every other point is on an edge.

    Points somewhat beyond the torque limit take part with a handicap: the best allowed gait is
    often beside them, and not beside any allowed point of the set.
    """
    rng, size = np.random.default_rng(seed), len(box.free)
    unit = qmc.Sobol(size, rng=seed).random(points)
    edge = (rng.random(unit.shape) < 0.4) & (np.arange(points) % 2 == 0)[:, None]
    unit[edge] = rng.integers(0, 2, edge.sum())
    value = []
    for part in np.array_split(unit, max(1, points // CHUNK)):
        gain, done = box.performance(box.low + part * (box.high - box.low), 64)
        over = np.nan_to_num(np.maximum(done.torque / box.problem.limits.torque - 1, 0.0))
        value.append(np.where(over < 0.3, gain - np.abs(gain) * 2 * over, -np.inf))
    order, kept = np.argsort(-np.concatenate(value)), []
    for x in unit[order[: points // 2]]:
        if all(np.max(np.abs(x - y)) > APART for y in kept):
            kept.append(x)
        if len(kept) == BEST:
            break
    kept.extend(unit[1 : 2 * SPREAD : 2])
    return box.low + np.array(kept) * (box.high - box.low)


def cloud(box: Box, x: Array, nodes: int, seed: int = 0) -> Array:
    """The best point found by 40 rounds of random points ever closer around the best so far."""
    rng, best = np.random.default_rng(seed), score(box, x[None], nodes=nodes, finer=16)[0]
    for radius in np.geomspace(0.1, 1e-7, 40):
        step = rng.normal(size=(64, len(x))) * radius * (box.high - box.low)
        step *= rng.random(step.shape) < 0.7
        X = np.clip(x + step, box.low, box.high)
        value = score(box, X, nodes=nodes, finer=16)
        if value.max() > best:
            x, best = X[value.argmax()], value.max()
    return x


def converged(box: Box, x: Array, nodes: int = 256) -> tuple[Array, int]:
    """Polished on ever more nodes until doubling them moves the speed by less than 1e-10."""
    while True:
        x, _ = polish(box, x, nodes, finer=16, windows=8, tolerance=1e-14)
        speed, finer = box.gait(x, nodes).speed, box.gait(x, 2 * nodes).speed
        if abs(speed - finer) <= 1e-10 * abs(finer) or nodes >= 4096:
            return x, nodes
        nodes *= 2


def replay(problem: Problem, gait: Gait) -> dict[str, float]:
    """Speed and peak torque by solve_ivp on multiplier equations, and the relative differences."""
    robot, choice = problem.robot, problem.inertia_ratio
    if choice is not None:
        robot = with_inertia_ratio(robot, gait.ratio, choice.about, choice.by, choice.loads)
    sine = (gait.amplitude, gait.period, gait.offset)
    speed, turn, torque = check_fourier.steady_by_shooting(robot, sine, 1024)
    torque = peaks(torque[None], 4, 1)[0, 0]
    return {
        "turn": float(turn),
        "replayed_speed_error": float(abs(speed / gait.speed - 1)),
        "replayed_torque_error": float(abs(torque / gait.torque - 1)),
    }


def best_known(name: str, points: int = POINTS) -> dict:
    problem, begin = PROBLEMS[name], time.process_time()
    box = Box(problem)
    found = [polish(box, x, **COARSE)[0] for x in starts(box, points)]
    value = score(box, np.array(found), 1e-4, **FINE)  # coarse nodes miss the torque's peak
    order = np.argsort(-value)
    optima = sorted({round(abs(float(v)), 5) for v in value if v > 0}, reverse=True)
    ends = [converged(box, found[n]) for n in order[:4] if value[n] > -np.inf]
    worth = [score(box, x[None], nodes=n, finer=16)[0] for x, n in ends]
    x, nodes = ends[int(np.argmax(worth))]
    by_grid, before = box.gait(x, nodes), max(worth)

    answers = [
        differential_evolution.solve(problem, seed, popsize=32, tol=1e-3) for seed in range(3)
    ]
    better = [a for a in answers if a.feasible and abs(a.gait.speed) > before * (1 + 1e-7)]
    if better:
        most = max(better, key=lambda a: abs(a.gait.speed))
        other, n = converged(box, np.array(most.point))
        if score(box, other[None], nodes=n, finer=16)[0] > before:
            x, nodes = other, n
    near = cloud(box, x, nodes)
    near, _ = converged(box, near, nodes)
    gain = score(box, np.array([x, near]), nodes=nodes, finer=16)
    if gain[1] > gain[0]:
        x = near
    best = box.gait(x, nodes)
    return {
        "speed": best.speed,
        "amplitude": best.amplitude,
        "period": best.period,
        "offset": best.offset,
        "inertia_ratio": best.ratio,
        "torque": best.torque,
        "along": best.along,
        "active": active(problem, best),
        "nodes": nodes,
        **replay(problem, best),
        "by_grid": by_grid.speed,
        "by_differential_evolution": [a.gait.speed for a in answers if a.feasible],
        "cloud_gain": float(gain[1] / gain[0] - 1),
        "local_optima": optima[:8],
        "cpu_seconds": round(time.process_time() - begin, 1),
    }


def active(problem: Problem, g: Gait) -> list[str]:
    """The names of the limits and bounds that hold the best gait back."""
    limits, gait, choice = problem.limits, problem.gait, problem.inertia_ratio
    cosine = math.cos(min(abs(g.offset) + g.amplitude, math.pi))
    s1 = problem.robot.platform1.c * cosine + problem.robot.platform2.c
    near = {
        "rate": g.amplitude * 2 * math.pi / g.period >= limits.rate * (1 - 1e-6),
        "torque": g.torque >= limits.torque * (1 - 1e-5),
        "angle": abs(g.offset) + g.amplitude >= limits.angle - 1e-6,
        "singularity": s1 <= limits.singularity + 1e-7,
    }
    values = [("amplitude", gait.amplitude, g.amplitude), ("period", gait.period, g.period)]
    values.append(("offset", gait.offset, g.offset))
    if choice is not None:
        values.append(("inertia_ratio", choice.bounds, g.ratio))
    for label, bound, value in values:
        edge = min(abs(value - bound.low), abs(value - bound.high))
        near[label] = not bound.fixed and edge <= 1e-6
    return [label for label, held in near.items() if held]


def store(answers: dict[str, dict]) -> None:
    with tempfile.NamedTemporaryFile("w", dir=STORE.parent, suffix=".tmp", delete=False) as file:
        json.dump(answers, file, indent=1, sort_keys=True)
        file.write("\n")
    Path(file.name).chmod(0o644)
    Path(file.name).replace(STORE)


def main(names: list[str]) -> None:
    answers = json.loads(STORE.read_text()) if STORE.exists() and names else {}
    for name in names or PROBLEMS:
        answers[name] = best_known(name)
        store(answers)
        print(name, json.dumps(answers[name]), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
