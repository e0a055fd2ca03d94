"""Starts for multiple shooting: scan the whole box coarsely, climb from every promising point.

The scan is a low-discrepancy set. From the best of it, and from every point that beats its
neighbours, all candidates climb together: each iteration lays a small stencil around every
candidate, evaluates all stencils in one call, fits a quadratic to each and moves to its maximum.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.decisions import Decisions
from rr_opt.design.landscape import Landscape

Array = NDArray[np.float64]

_NODES = 24
_POINTS = {0: 1, 1: 48, 2: 160, 3: 320, 4: 512}
_CLIMBERS = {0: 1, 1: 4, 2: 6, 3: 8, 4: 10}
_ITERATIONS = 6
_TORQUE_PENALTY = 2.0
# A start this much slower than the best is not climbed from.
_PROMISING = 0.3


class Merit(Protocol):
    """What a climb maximises: points (K, 4) and their directions (K,) -> values (K,)."""

    def __call__(self, points: Array, sign: Array, /) -> Array: ...


@dataclass(frozen=True)
class Seed:
    """A start: its direction (+1 forward, -1 backward), its point of the unit box (4,)."""

    sign: int
    point: Array


def find_seeds(
    landscape: Landscape, decisions: Decisions, torque_limit: float, signs: tuple[int, ...]
) -> list[Seed]:
    """Starts that are each in a basin of their own as far as the scan can tell, best first."""

    def merit(points: Array, sign: Array) -> Array:
        cycles = landscape.cycles(decisions.physical(points), _NODES)
        excess = np.maximum(cycles.peak_torque / torque_limit - 1.0, 0.0)
        return sign * cycles.speed - _TORQUE_PENALTY * excess

    free = decisions.free
    points = _scan(decisions)
    cycles = landscape.cycles(decisions.physical(points), _NODES)
    excess = np.maximum(cycles.peak_torque / torque_limit - 1.0, 0.0)
    both = np.concatenate([points, points])
    sign = np.repeat([1, -1], len(points))
    values = sign * np.tile(cycles.speed, 2) - _TORQUE_PENALTY * np.tile(excess, 2)
    values[~np.isin(sign, signs)] = -np.inf
    chosen = _peaks(both[:, free], sign, values, _CLIMBERS[len(free)])
    if not chosen:
        return []
    x, best = _climb(both[chosen], sign[chosen], free, merit)
    return _distinct(x, best, sign[chosen])


def least_torque(landscape: Landscape, decisions: Decisions) -> tuple[float, Array]:
    """The smallest peak torque of any gait of the box, N m, and its point of the unit box."""

    def merit(points: Array, _sign: Array) -> Array:
        return -landscape.cycles(decisions.physical(points), 2 * _NODES).peak_torque

    points, free = _scan(decisions), decisions.free
    values = merit(points, np.ones(len(points)))
    sign = np.ones(len(points), int)
    chosen = _peaks(points[:, free], sign, values, _CLIMBERS[len(free)])
    x, best = _climb(points[chosen], sign[chosen], free, merit)
    top = int(np.argmax(best))
    return -float(best[top]), x[top]


def _scan(decisions: Decisions) -> Array:
    """Points of the unit box along the free coordinates: Roberts' additive recurrence, stretched
    so that a sixth of them lies on each pair of faces, where optima tend to be. Gaits at phi0
    and -phi0 are mirror images, so of a symmetric range one half is enough."""
    free = decisions.free
    count, d = _POINTS[len(free)], len(free)
    points = np.zeros((count, 4))
    if not d:
        return points
    golden = 2.0
    for _ in range(40):
        golden = (1 + golden) ** (1 / (d + 1))
    steps = golden ** -np.arange(1, d + 1)
    unit = (0.5 + np.outer(np.arange(1, count + 1), steps)) % 1.0
    points[:, free] = np.clip(unit * 1.2 - 0.1, 0.0, 1.0)
    if decisions.mirrored:
        points[:, 1] = 0.5 + points[:, 1] / 2
    return points


def _peaks(points: Array, sign: Array, values: Array, most: int) -> list[int]:
    """Indices of the best points that keep their distance from better ones, best first."""
    apart = 0.3
    open_ = np.isfinite(values)
    if open_.any():
        top = values[open_].max()
        open_ &= values >= top - (1 - _PROMISING) * abs(top)
    chosen: list[int] = []
    while open_.any() and len(chosen) < most:
        best = int(np.argmax(np.where(open_, values, -np.inf)))
        chosen.append(best)
        distance = np.abs(points - points[best]).max(axis=1, initial=0.0)
        open_ &= (distance > apart) | (sign != sign[best])
    return chosen


def _climb(x: Array, sign: Array, free: list[int], merit: Merit) -> tuple[Array, Array]:
    """Climb from x (K, 4) all at once; returns points and their merit."""
    d = len(free)
    if not d:
        return x, merit(x, sign)
    pairs = list(combinations(range(d), 2))
    stencil = np.zeros((1 + 2 * d + len(pairs), d))
    for i in range(d):
        stencil[1 + 2 * i, i], stencil[2 + 2 * i, i] = 1.0, -1.0
    for row, (i, j) in enumerate(pairs, start=1 + 2 * d):
        stencil[row, [i, j]] = 1.0
    size = np.full(len(x), 0.08)
    best = merit(x, sign)
    for _ in range(_ITERATIONS):
        # Near a face the stencil moves inside; its quadratic still serves up to the face.
        centre = np.clip(x[:, free], size[:, None], 1 - size[:, None])
        trial = np.repeat(x[:, None, :], len(stencil), axis=1)
        trial[:, :, free] = centre[:, None, :] + size[:, None, None] * stencil
        values = merit(trial.reshape(-1, 4), np.repeat(sign, len(stencil)))
        values = values.reshape(len(x), -1)
        step = _quadratic_maximum(values, d, pairs, centre, size)
        aim = x.copy()
        aim[:, free] = centre + step
        reached = merit(aim, sign)
        top = values.argmax(axis=1)
        sampled = values[np.arange(len(x)), top]
        use_sample = sampled > reached
        aim[use_sample] = trial[np.arange(len(x)), top][use_sample]
        reached = np.maximum(sampled, reached)
        better = reached > best
        x[better], best = aim[better], np.maximum(best, reached)
        size = np.where(better, size * 0.7, size * 0.35)
    return x, best


def _quadratic_maximum(
    values: Array, d: int, pairs: list[tuple[int, int]], centre: Array, size: Array
) -> Array:
    """Steps (K, d) to the maxima of the quadratics through the stencils' values, within twice
    the stencil and the unit box, by coordinate ascent."""
    middle, up, down = values[:, :1], values[:, 1 : 1 + 2 * d : 2], values[:, 2 : 2 + 2 * d : 2]
    g = (up - down) / 2
    H = np.zeros((len(values), d, d))
    H[:, range(d), range(d)] = up + down - 2 * middle
    for row, (i, j) in enumerate(pairs, start=1 + 2 * d):
        mixed = values[:, row] - up[:, i] - up[:, j] + middle[:, 0]
        H[:, i, j] = H[:, j, i] = mixed
    low = np.maximum(-2.0, -centre / size[:, None])
    high = np.minimum(2.0, (1 - centre) / size[:, None])
    s = np.zeros_like(g)
    for _ in range(6):
        for i in range(d):
            slope = g[:, i] + np.einsum("kj,kj->k", H[:, i], s) - H[:, i, i] * s[:, i]
            curve = H[:, i, i]
            inner = np.clip(-slope / np.where(curve < 0, curve, -1.0), low[:, i], high[:, i])
            ends = np.where(
                slope * low[:, i] + curve / 2 * low[:, i] ** 2
                > slope * high[:, i] + curve / 2 * high[:, i] ** 2,
                low[:, i],
                high[:, i],
            )
            s[:, i] = np.where(curve < 0, inner, ends)
    return s * size[:, None]


def _distinct(x: Array, values: Array, sign: Array) -> list[Seed]:
    kept: list[int] = []
    for i in np.argsort(-values):
        if all(sign[i] != sign[j] or np.abs(x[i] - x[j]).max() > 0.04 for j in kept):
            kept.append(int(i))
    return [Seed(int(sign[i]), x[i]) for i in kept]
