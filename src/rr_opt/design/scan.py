"""The whole unit box seen coarsely, and the points of it to climb from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.design.climb import Effort, Merit, climb, polished, spread
from rr_opt.design.decisions import Decisions
from rr_opt.design.landscape import Cycles, Landscape

# Phases of the scan and its climb, then of the climb that goes on from their tops: near the
# singular posture the coarse landscape has ripples that hold climbers back.
NODES, FINER_NODES = 24, 48
POINTS = {0: 1, 1: 48, 2: 160, 3: 320, 4: 512}
CLIMBERS = {0: 1, 1: 4, 2: 6, 3: 8, 4: 10}
# A start this much slower than the best is not climbed from.
PROMISING = 0.3
_APART = 0.3
# A search for what no gait can do is made once, and its answer has to be sure.
_PATIENCE, _ENDS, _FINEST_NODES = 3, 4, 96
# The values of a gait that has no steady cycle.
_GROSS = 1e6
ROUGH = Effort(iterations=8, first=0.08, last=0.02)
THOROUGH = Effort(iterations=25, first=0.04, last=0.006)

Look = Callable[[Cycles, Array, Array], Array]
"""Cycles, their gaits (4, K) and directions (K,) -> what is maximised and rows, (1 + R, K)."""


@dataclass(frozen=True)
class Seed:
    """A start: its direction (+1 forward, -1 backward), its point of the unit box (4,)."""

    sign: int
    point: Array


def scan(decisions: Decisions, count: int) -> Array:
    """Points of the unit box along the free coordinates, stretched so that a sixth of them lies
    on each pair of faces, where optima tend to be. Gaits at phi0 and -phi0 are mirror images, so
    of a symmetric range one half is enough, if it does not matter which way they turn."""
    free = decisions.free
    points = np.zeros((count, 4))
    if free:
        points[:, free] = np.clip(spread(len(points), len(free)) * 1.2 - 0.1, 0.0, 1.0)
    if decisions.mirrored:
        points[:, 1] = 0.5 + points[:, 1] / 2
    return points


def peaks(points: Array, sign: Array, values: Array, most: int, least: float) -> list[int]:
    """Indices of the best points that keep their distance from better ones, best first; none
    whose value is below the least."""
    open_ = values >= least
    chosen: list[int] = []
    while open_.any() and len(chosen) < most:
        best = int(np.argmax(np.where(open_, values, -np.inf)))
        chosen.append(best)
        distance = np.abs(points - points[best]).max(axis=1, initial=0.0)
        open_ &= (distance > _APART) | (sign != sign[best])
    return chosen


def share_of(best: float, share: float) -> float:
    """The value that is this share of the best, or as much worse where that is negative."""
    return best - (1 - share) * abs(best)


def search(
    landscape: Landscape, decisions: Decisions, look: Look, merit: Merit, signs: tuple[int, ...]
) -> tuple[Array, int, float]:
    """The point of the box (4,) with the most merit as far as a scan and climbs from its best
    points tell, its direction and its merit."""

    def terrain(points: Array, sign: Array, nodes: int = FINER_NODES) -> Array:
        gaits = decisions.physical(points)
        with np.errstate(invalid="ignore"):
            seen = look(landscape.cycles(gaits, nodes), gaits, sign)
        seen[0, ~np.isfinite(seen).all(axis=0)] = -_GROSS
        return np.where(np.isfinite(seen), seen, 0.0)

    free = decisions.free
    points = scan(decisions, _PATIENCE * POINTS[len(free)])
    sign = np.repeat(signs, len(points))
    points = np.concatenate([points for _ in signs])
    values = merit(terrain(points, sign))
    least = share_of(values.max(), PROMISING)
    most = _PATIENCE * CLIMBERS[len(free)]
    chosen = peaks(points[:, free], sign, values, most, least)
    tops, ways, _ = climb(points[chosen], sign[chosen], free, terrain, merit, THOROUGH)

    def ended(top: Array, way: int) -> tuple[Array, float]:
        way_there = np.array([way])
        return polished(
            lambda x: float(merit(terrain(x[None], way_there, _FINEST_NODES))[0]), top, free
        )

    ends = [(*ended(top, way), int(way)) for top, way in zip(tops[:_ENDS], ways, strict=False)]
    point, value, way = max(ends, key=lambda end: end[1])
    return point, way, value
