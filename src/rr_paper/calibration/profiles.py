"""Profile likelihoods of the unknowns.

A value is inside the 95 % interval if the deviance there, minimised over the other unknowns, is
within 3.84 of the least. That holds asymptotically, for many data.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from rr_opt.array import Array
from rr_paper.calibration.fit import Estimator, descend
from rr_paper.calibration.likelihood import Data, Distribution
from rr_paper.calibration.unknowns import Unknown

LEVEL = float(chi2.ppf(0.95, 1))
"""3.84."""
JOINT_LEVEL = float(chi2.ppf(0.95, 4))
"""9.49: how far the deviance of four unknowns together may rise, if there were many data."""

_ROUNDS = 3
"""How often the results are tried as starts at the neighbouring values."""
_DISTANCE = 0.03
"""Distance from a value, as a share of the box, that weighs like a deviance of 1."""


@dataclass(frozen=True)
class Profile:
    """grid (M,), shares of the box of one unknown, and the least deviance at each (M,).

    points     where it is least, (M, unknowns)
    bottom     the least deviance of all
    low, high  the 95 % interval, shares; 0 or 1 where the box and not the data ends it
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

    def ends(self, unknown: Unknown) -> tuple[float, float]:
        """The 95 % interval, SI."""
        low, high = unknown.value([self.low, self.high]).tolist()
        return low, high


def profiles(
    estimator: Estimator,
    data: Data,
    unknowns: Sequence[int],
    distribution: Distribution = "student",
) -> tuple[Profile, ...]:
    """One for each of the unknowns, given by index.

    The search at a value starts from the best points of the library near it. Its result is then
    tried as a start at the neighbouring values, as one search alone may end in a side valley.
    """
    effort = estimator.effort
    grid = np.linspace(0, 1, effort.values)
    library = data.deviance(estimator.speeds, distribution)

    def nearby(unknown: int, value: float) -> Array:
        distance = np.abs(estimator.points[:, unknown] - value)
        order = np.argsort(library + (distance / _DISTANCE) ** 2)
        return estimator.points[order[: effort.starts]]

    def search(starts: Array) -> tuple[Array, Array]:
        """The best points (U, M, unknowns) and deviances (U, M), from starts (U, M, starts,
        unknowns), with each of U unknowns fixed at each of M values."""
        starts, size = starts.copy(), starts.shape[-1]
        fixed = np.zeros(starts.shape, bool)
        for row, unknown in enumerate(unknowns):
            starts[row, :, :, unknown] = grid[:, None]
            fixed[row, :, :, unknown] = True
        x, deviance = descend(
            estimator.predict, starts.reshape(-1, size), data, effort.steps,
            distribution=distribution, fixed=fixed.reshape(-1, size),
        )  # fmt: skip
        x, deviance = x.reshape(starts.shape), deviance.reshape(starts.shape[:-1])
        first = deviance.argmin(axis=2)[:, :, None]
        best = np.take_along_axis(x, first[..., None], axis=2)[:, :, 0]
        return best, np.take_along_axis(deviance, first, axis=2)[:, :, 0]

    best, least = search(
        np.array([[nearby(unknown, value) for value in grid] for unknown in unknowns])
    )
    for _ in range(_ROUNDS):
        best, least = search(
            np.stack([best, np.roll(best, 1, axis=1), np.roll(best, -1, axis=1)], axis=2)
        )
    bottom = min(float(least.min()), float(library.min()))
    return tuple(
        Profile(grid, row, points, bottom, *_interval(grid, row - bottom))
        for row, points in zip(least, best, strict=True)
    )


def _interval(grid: Array, rise: Array) -> tuple[float, float]:
    """First and last place where the rise is below LEVEL, interpolated between the values."""
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
