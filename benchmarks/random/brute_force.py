"""The best gait of a problem by a search that shares no code with the package.

8192 quasi-random gaits on the hand-written array model, half of them on edges of the box;
the best of every region polished by SLSQP, and the best of those again on more nodes.
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks.optimise.brute_force import score
from benchmarks.optimise.brute_force import starts as regions
from benchmarks.optimise.polish import polish
from benchmarks.optimise.space import Box
from benchmarks.turn.brute_force import Turning
from benchmarks.turn.brute_force import starts as turning_regions
from rr_opt.model.problem import Problem

_POINTS = 2**13
_POLISHED, _FINAL = 12, 2
_NODES = (96, 384)


def best(problem: Problem) -> float:
    """Its |speed|, m/s; 0 where none was found."""
    with np.errstate(all="ignore"):
        return _turn(problem) if problem.turn else _free(problem)


def _free(problem: Problem) -> float:
    box = Box(problem)
    if not len(box.free) or (box.low > box.high).any():
        x = np.zeros((1, len(box.free)))
        return max(float(score(box, x, nodes=512, finer=16)[0]), 0.0)
    ends = []
    for x in regions(box, _POINTS)[:_POLISHED]:
        try:
            ends.append(polish(box, x, _NODES[0], finer=4)[0])
        except (ValueError, np.linalg.LinAlgError):
            continue
    if not ends:
        return 0.0
    rough = score(box, np.array(ends), 1e-3, nodes=_NODES[1], finer=8)
    found = 0.0
    for k in np.argsort(-rough)[:_FINAL]:
        if rough[k] > 0:
            x, _ = polish(box, ends[k], _NODES[1], finer=16, windows=8, tolerance=1e-13)
            found = max(found, float(score(box, x[None], 1e-6, nodes=_NODES[1], finer=16)[0]))
    return found


def _turn(problem: Problem) -> float:
    box = Box(problem)
    least, span = box.least[box.free], (box.most - box.least)[box.free]
    ends: list[tuple[np.ndarray, float]] = []
    coarse, fine = Turning(box, _NODES[0], 4, 8), Turning(box, _NODES[1], 16, 8)
    for point in turning_regions(box, points=_POINTS).T[:_POLISHED]:
        z = np.clip((point[box.free] - least) / span, 0.0, 1.0)
        try:
            ends.append(coarse.polished(z, 1e-9))
        except (ValueError, np.linalg.LinAlgError):
            continue
    found = 0.0
    for z, gain in sorted(ends, key=lambda end: -end[1])[:_FINAL]:
        if gain > -math.inf:
            found = max(found, fine.polished(z, 1e-13)[1])
    return found
