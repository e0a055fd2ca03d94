"""Starts for multiple shooting: scan the whole box coarsely, climb from every promising point."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.climb import Effort, climb, merit, spread
from rr_opt.design.decisions import Decisions
from rr_opt.design.landscape import Landscape

Array = NDArray[np.float64]

# Phases of the scan and its climb, then of the climb that goes on from their tops: near the
# singular posture the coarse landscape has ripples that hold climbers back.
_NODES, _FINER_NODES = 24, 48
_POINTS = {0: 1, 1: 48, 2: 160, 3: 320, 4: 512}
_CLIMBERS = {0: 1, 1: 4, 2: 6, 3: 8, 4: 10}
# A start this much slower than the best is not climbed from; a top, not solved from.
_PROMISING, _WORTH_SOLVING = 0.3, 0.5
_APART = 0.3
_FEW = 2
# What a gait counts as using of the torque limit that has no steady cycle.
_UNSETTLED = 10.0
_ROUGH = Effort(iterations=8, first=0.08, last=0.02)
_THOROUGH = Effort(iterations=25, first=0.04, last=0.006)


@dataclass(frozen=True)
class Seed:
    """A start: its direction (+1 forward, -1 backward), its point of the unit box (4,)."""

    sign: int
    point: Array


def find_seeds(
    landscape: Landscape, decisions: Decisions, torque_limit: float, signs: tuple[int, ...]
) -> tuple[list[Seed], float]:
    """Starts that are each in a basin of their own as far as the scan can tell, best first, and
    the speed of the best, m/s: negative if it goes against its direction."""

    def terrain(points: Array, sign: Array, nodes: int = _NODES) -> tuple[Array, Array]:
        cycles = landscape.cycles(decisions.physical(points), nodes)
        speed, torque = sign * cycles.speed, cycles.peak_torque / torque_limit
        settled = np.isfinite(speed) & np.isfinite(torque)
        return np.where(settled, speed, 0.0), np.where(settled, torque, _UNSETTLED)

    free = decisions.free
    points = _scan(decisions)
    speed, torque = terrain(points, np.ones(len(points)))
    penalty = 3 * float(np.abs(speed).max())
    candidates = np.concatenate([points for _ in signs])
    sign = np.repeat(signs, len(points))
    values = np.concatenate([merit(direction * speed, torque, penalty) for direction in signs])
    chosen = _peaks(candidates[:, free], sign, values, _CLIMBERS[len(free)])
    tops, sign, values = climb(candidates[chosen], sign[chosen], free, terrain, penalty, _ROUGH)
    worth = values >= values[0] - (1 - _WORTH_SOLVING) * abs(values[0])
    tops, sign = tops[worth], sign[worth]
    if decisions.mirrored:
        tops[:, 1] = np.maximum(tops[:, 1], 1 - tops[:, 1])
    # A few tops are solved from sooner than told apart.
    if len(tops) > _FEW:
        finer = partial(terrain, nodes=_FINER_NODES)
        tops, sign, values = climb(tops, sign, free, finer, penalty, _THOROUGH)
    least = values[0] - (1 - _WORTH_SOLVING) * abs(values[0])
    seeds = [Seed(int(sign[i]), tops[i]) for i in np.flatnonzero(values >= least)]
    return seeds, float(values[0])


def least_torque(landscape: Landscape, decisions: Decisions) -> float:
    """The smallest peak torque of any gait of the box, N m."""

    def terrain(points: Array, sign: Array) -> tuple[Array, Array]:
        cycles = landscape.cycles(decisions.physical(points), _FINER_NODES)
        return -np.nan_to_num(cycles.peak_torque, nan=1e6, posinf=1e6), np.zeros(len(sign))

    points, free = _scan(decisions), decisions.free
    sign = np.ones(len(points), int)
    chosen = _peaks(points[:, free], sign, terrain(points, sign)[0], _CLIMBERS[len(free)])
    return -float(climb(points[chosen], sign[chosen], free, terrain, 0.0, _THOROUGH)[2][0])


def _scan(decisions: Decisions) -> Array:
    """Points of the unit box along the free coordinates, stretched so that a sixth of them lies
    on each pair of faces, where optima tend to be. Gaits at phi0 and -phi0 are mirror images, so
    of a symmetric range one half is enough."""
    free = decisions.free
    points = np.zeros((_POINTS[len(free)], 4))
    if free:
        points[:, free] = np.clip(spread(len(points), len(free)) * 1.2 - 0.1, 0.0, 1.0)
    if decisions.mirrored:
        points[:, 1] = 0.5 + points[:, 1] / 2
    return points


def _peaks(points: Array, sign: Array, values: Array, most: int) -> list[int]:
    """Indices of the best points that keep their distance from better ones, best first."""
    top = values.max()
    open_ = values >= top - (1 - _PROMISING) * abs(top)
    chosen: list[int] = []
    while open_.any() and len(chosen) < most:
        best = int(np.argmax(np.where(open_, values, -np.inf)))
        chosen.append(best)
        distance = np.abs(points - points[best]).max(axis=1, initial=0.0)
        open_ &= (distance > _APART) | (sign != sign[best])
    return chosen
