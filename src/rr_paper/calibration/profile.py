"""Profile likelihood: for each value of one unknown, how well the others can make up for it.

A value is inside the 95 % interval if the deviance there is within 3.84 of the least. That the
deviance falls so is a theorem for many data; whether it holds for nine is what
`coverage` counts.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from rr_opt.array import Array
from rr_paper.calibration.fit import descend, problems
from rr_paper.calibration.models import Law, Measured

LEVEL = float(chi2.ppf(0.95, 1))
"""3.84."""

_ROUNDS = 3
"""How often what was found is tried as a start at the values beside it."""


@dataclass(frozen=True)
class Profile:
    """grid (M,), shares of the box of one unknown, and the least deviance at each (M,).

    points     where it is least, (M, unknowns)
    bottom     the least deviance of all
    low, high  the 95 % interval, shares; open where it reaches a side of the box
    """

    grid: Array
    deviance: Array
    points: Array
    bottom: float
    low: float
    high: float

    @property
    def rise(self) -> Array:
        """Deviance above the least, (M,)."""
        return self.deviance - self.bottom

    @property
    def open_below(self) -> bool:
        """The box, not the data, ends the interval below."""
        return self.low <= 0.0

    @property
    def open_above(self) -> bool:
        """The box, not the data, ends the interval above."""
        return self.high >= 1.0


def profiles(
    predict: Callable[[Array], Array],
    data: Measured,
    candidates: Array,
    deviance: Array,
    *,
    unknowns: Sequence[int],
    law: Law = "student",
    values: int,
    starts: int,
    steps: int,
) -> list[Profile]:
    """One for each of the unknowns named by place; predict gives speeds counted one way.

    candidates (N, unknowns) with their deviance (N,): the best of them near a value are where
    the search at that value starts. What it finds is then tried as a start at the values beside
    it, as one search alone may end in a side valley.
    """
    grid = np.linspace(0, 1, values)
    shape = (len(unknowns), values, -1, candidates.shape[1])
    begin = np.array(
        [
            _starts(candidates, deviance, unknown, value, starts)
            for unknown in unknowns
            for value in grid
        ]
    ).reshape(shape)
    best, least = _held(predict, data, law, begin, unknowns, grid, steps)
    for _ in range(_ROUNDS):
        beside = np.stack([best, np.roll(best, 1, axis=1), np.roll(best, -1, axis=1)], axis=2)
        best, least = _held(predict, data, law, beside, unknowns, grid, steps)
    bottom = min(float(least.min()), float(deviance.min()))
    return [
        Profile(grid, row, points, bottom, *_interval(grid, row - bottom))
        for row, points in zip(least, best, strict=True)
    ]


def _held(
    predict: Callable[[Array], Array],
    data: Measured,
    law: Law,
    begin: Array,
    unknowns: Sequence[int],
    grid: Array,
    steps: int,
) -> tuple[Array, Array]:
    """The best points (U, M, unknowns), from starts (U, M, starts, unknowns), in which each of U
    unknowns is held at each of M values; and their deviance (U, M)."""
    begin, size = begin.copy(), begin.shape[-1]
    for row, unknown in enumerate(unknowns):
        begin[row, :, :, unknown] = grid[:, None]
    flat = begin.reshape(-1, size)
    held = np.repeat(np.eye(size, dtype=bool)[list(unknowns)], len(flat) // len(unknowns), axis=0)
    posed = problems(predict, flat, data.speed, data.error, law=law, fixed=held)
    x, found = descend(posed, flat, steps)
    x, found = x.reshape(begin.shape), found.reshape(begin.shape[:-1])
    first = found.argmin(axis=2)[:, :, None]
    best = np.take_along_axis(x, first[..., None], axis=2)[:, :, 0]
    return best, np.take_along_axis(found, first, axis=2)[:, :, 0]


def _starts(candidates: Array, deviance: Array, unknown: int, value: float, count: int) -> Array:
    """The candidates that are best once the distance to the value is held against them."""
    distance = np.abs(candidates[:, unknown] - value)
    order = np.argsort(deviance + (distance / 0.03) ** 2)
    return candidates[order[:count]]


def _interval(grid: Array, rise: Array) -> tuple[float, float]:
    """First and last place where the rise is below LEVEL, between the grid's values too."""
    inside = np.flatnonzero(rise <= LEVEL)
    if not len(inside):
        at = float(grid[np.argmin(rise)])
        return at, at
    first, last = int(inside[0]), int(inside[-1])

    def crossing(outer: int, inner: int) -> float:
        share = (LEVEL - rise[inner]) / (rise[outer] - rise[inner])
        return float(grid[inner] + share * (grid[outer] - grid[inner]))

    low = 0.0 if first == 0 else crossing(first - 1, first)
    high = 1.0 if last == len(grid) - 1 else crossing(last + 1, last)
    return low, high
