"""The best known gait of every turn, by a search too slow for anything but a benchmark.

A hundred thousand quasi-random gaits on the hand-written array model; the best of every region,
by speed less a penalty for being off the turn, polished by SLSQP with the turn as a constraint.

`python -m benchmarks.turn.brute_force [PROBLEM ...]` rewrites best_known.json.
"""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path

import numpy as np
from scipy import optimize
from scipy.stats import qmc

from benchmarks.optimise.fourier_numpy import Array
from benchmarks.optimise.polish import Local
from benchmarks.optimise.space import Box
from benchmarks.turn.problems import PROBLEMS
from rr_opt.model.problem import Problem

STORE = Path(__file__).with_name("best_known.json")
POINTS, CHUNK = 2**17, 2**12
BEST, APART = 60, 0.06
KEPT = 1e-7  # of a row's scale
NODES = (96, 256, 512)


def rows_of(problem: Problem, gaits: Array, speed: Array, turn: Array) -> Array:
    """(value, low, high), each scaled, of what is asked, (rows, 3, points)."""
    period, asked = gaits[1], problem.turn
    seen = {
        "curvature": turn / (period * np.abs(speed)),
        "yaw_rate": turn / period,
        "heading": turn,
    }
    rows = []
    for name, value in seen.items():
        bounds = getattr(asked, name)
        ends = [end for end in (bounds.low, bounds.high) if math.isfinite(end)]
        if ends:
            size = max(map(abs, ends))
            rows.append(np.broadcast_arrays(value / size, bounds.low / size, bounds.high / size))
    return np.array(rows)


class Turning(Local):
    """SLSQP with the turn's rows as equalities or inequalities."""

    def values(self, Z: Array) -> Array:
        """As in Local, then the rows of the turn."""
        gaits = self.gaits(Z)
        _, done = self.box.drive(gaits, *self.how)
        rows = rows_of(self.box.problem, gaits, done.speed, done.turn)
        equal = rows[:, 1, 0] == rows[:, 2, 0]
        self.equalities = int(equal.sum())
        low, high = rows[~equal, 0] - rows[~equal, 1], rows[~equal, 2] - rows[~equal, 0]
        bounded = np.concatenate([low[np.isfinite(low[:, 0])], high[np.isfinite(high[:, 0])]])
        met = rows[equal, 0] - rows[equal, 1]
        return np.concatenate([super().values(Z), bounded, met])

    def polished(self, z: Array, tolerance: float) -> tuple[Array, float]:
        """Where SLSQP ends, and its gain; -inf if it keeps to no turn."""
        k = len(self.look(z)[0]) - self.equalities

        def part(kind: str, rows: slice) -> dict:
            return {
                "type": kind,
                "fun": lambda z: self.look(z)[0][rows],
                "jac": lambda z: self.look(z)[1][rows],
            }

        constraints = [part("ineq", slice(1, k))]
        if self.equalities:
            constraints.append(part("eq", slice(k, None)))
        for _ in range(2):
            z = np.clip(
                optimize.minimize(
                    lambda z: -self.look(z)[0][0],
                    z,
                    jac=lambda z: -self.look(z)[1][0],
                    bounds=[(0.0, 1.0)] * len(z),
                    constraints=constraints,
                    method="SLSQP",
                    options={"ftol": tolerance, "maxiter": 200},
                ).x,
                0.0,
                1.0,
            )
        values = self.look(z)[0]
        met = values[1:k].min() >= -KEPT and np.abs(values[k:]).max(initial=0.0) <= KEPT
        return z, float(values[0]) if met and np.isfinite(values[0]) else -np.inf


def starts(box: Box, seed: int = 0, points: int = POINTS) -> Array:
    """The best points of a Sobol set, no two in one region, as gaits (4, starts)."""
    rng, size = np.random.default_rng(seed), len(box.free)
    unit = qmc.Sobol(size, rng=seed).random(points)
    edge = (rng.random(unit.shape) < 0.4) & (np.arange(points) % 2 == 0)[:, None]
    unit[edge] = rng.integers(0, 2, edge.sum())
    values = []
    for part in np.array_split(unit, max(1, points // CHUNK)):
        gaits, lost = box.gaits(box.low + part * (box.high - box.low))
        gain, done = box.drive(gaits, 64)
        rows = rows_of(box.problem, gaits, done.speed, done.turn)
        off = np.maximum(rows[:, 0] - rows[:, 2], rows[:, 1] - rows[:, 0]).clip(0.0, 5.0).sum(0)
        heavy = np.maximum(done.torque / box.problem.limits.torque - 1, 0.0)
        value = gain - np.abs(gain) * (2 * off + 2 * np.nan_to_num(heavy, nan=9.0))
        values.append(np.where((lost > 0) | ~np.isfinite(value), -np.inf, value))
    order, kept = np.argsort(-np.concatenate(values)), []
    for x in unit[order[: points // 4]]:
        if all(np.max(np.abs(x - y)) > APART for y in kept):
            kept.append(x)
        if len(kept) == BEST:
            break
    return box.gaits(box.low + np.array(kept) * (box.high - box.low))[0]


def best_known(problem: Problem) -> dict:
    begin = time.process_time()
    box, found = Box(problem), []
    least, span = box.least[box.free], (box.most - box.least)[box.free]
    coarse = Turning(box, NODES[0], 4, 8)
    for point in starts(box).T:
        z = np.clip((point[box.free] - least) / span, 0.0, 1.0)
        try:
            found.append(coarse.polished(z, 1e-10))
        except (ValueError, np.linalg.LinAlgError):
            continue
    order = sorted(found, key=lambda pair: -pair[1])[:6]
    ends = []
    for z, _ in order:
        gain = -math.inf
        for nodes in NODES[1:]:
            z, gain = Turning(box, nodes, 16, 8).polished(z, 1e-14)  # noqa: PLW2901
        ends.append((z, gain))
    z, gain = max(ends, key=lambda pair: pair[1])
    gait = Turning(box, NODES[-1], 16, 8).gaits(z[None])
    _, done = box.drive(gait, NODES[-1])
    names = ("amplitude", "period", "offset", "inertia_ratio")
    return {
        "speed": float(done.speed[0]) if gain > -math.inf else None,
        **dict(zip(names, gait[:, 0].tolist(), strict=True)),
        "turn": float(done.turn[0]),
        "torque": float(done.torque[0]),
        "optima": sorted({round(g, 6) for _, g in found if g > -math.inf}, reverse=True)[:6],
        "cpu_seconds": round(time.process_time() - begin, 1),
    }


def main(names: list[str]) -> None:
    answers = json.loads(STORE.read_text()) if STORE.exists() and names else {}
    for name in names or PROBLEMS:
        answers[name] = best_known(PROBLEMS[name])
        STORE.write_text(json.dumps(answers, indent=1, sort_keys=True) + "\n")
        print(name, json.dumps(answers[name]), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
