"""Profile likelihoods of the unknowns.

A value is inside the 95 % interval if the deviance there, minimised over the other unknowns, is
within 3.84 of the least. This holds asymptotically.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from rr_opt.array import Array
from rr_paper.calibration.fit import Data, Distribution, Estimator, descend
from rr_paper.calibration.models import Unknown

LEVEL = float(chi2.ppf(0.95, 1))
"""3.84."""
JOINT_LEVEL = float(chi2.ppf(0.95, 4))
"""9.49: the same for four unknowns jointly, asymptotically."""

_ROUNDS = 3
"""Rounds in which results are used as starts at the neighbouring values."""
_DISTANCE = 0.03
"""Distance from a value, as a share of the box, equivalent to a deviance of 1."""


@dataclass(frozen=True)
class Profile:
    """grid (M,), shares of the box of one unknown, and the least deviance at each (M,).

    points     where it is least, (M, unknowns)
    bottom     the least deviance of all
    low, high  the 95 % interval, shares; 0 or 1 where it is ended by the box, not the data
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

    The search at a value starts from the best points of the library near it. Its result is then a
    start at the neighbouring values, as a single search may end in a side valley.
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


_KEEP_EVERY = 5
_LONG_STEP_EVERY = 5
"""Occasionally a step is a whole difference, which carries a point from one valley to another."""


@dataclass(frozen=True)
class Posterior:
    """points (N, unknowns), shares of the boxes; deviance (N,).

    rhat            split R-hat of the worst unknown: near 1 if the chains agree
    library_weight  effective number of points of the library from which the draws started
    """

    points: Array
    deviance: Array
    rhat: float
    library_weight: float

    def quantiles(self, at: tuple[float, ...] = (0.025, 0.5, 0.975)) -> Array:
        """Of each unknown, as shares of its box, (len(at), unknowns)."""
        return np.quantile(self.points, at, axis=0)


def library_draws(
    estimator: Estimator, data: Data, count: int, draw: np.random.Generator
) -> tuple[Array, float]:
    """Points of the library drawn by their likelihood, (count, unknowns), and the effective number
    of points that share it."""
    deviance = data.deviance(estimator.speeds)
    likelihood = np.exp(-(deviance - deviance.min()) / 2)
    likelihood /= likelihood.sum()
    chosen = draw.choice(len(likelihood), count, p=likelihood)
    return estimator.points[chosen], float(1 / (likelihood**2).sum())


def sample(estimator: Estimator, data: Data, *, chains: int, sweeps: int) -> Posterior:
    """Draws from the posterior by Student's t, of the second half of the sweeps."""
    draw = np.random.default_rng(1)
    x, weight = library_draws(estimator, data, chains, draw)
    kept = evolve(estimator, x[None], data, sweeps, draw)[:, 0]
    points = kept.reshape(-1, x.shape[1])
    deviance = data.deviance(estimator.predict(points))
    return Posterior(points, deviance, _split_rhat(kept), weight)


def evolve(
    estimator: Estimator, x: Array, data: Data, sweeps: int, draw: np.random.Generator
) -> Array:
    """Sweeps of S data sets side by side, from chains x (S, C, unknowns).

    Returns the chains at every fifth sweep of the second half, (kept, S, C, unknowns).
    """
    x, (sets, chains, size) = x.copy(), x.shape
    rows = (sets, data.speed.shape[-1])
    data = Data(*(np.broadcast_to(part, rows)[:, None] for part in (data.speed, data.error)))

    def deviance(points: Array) -> Array:
        speeds = estimator.predict(points.reshape(-1, size))
        return data.deviance(speeds.reshape(sets, -1, rows[1]))

    D, kept = deviance(x), []
    halves = slice(0, chains // 2), slice(chains // 2, chains)
    for sweep in range(sweeps):
        for moving, lending in (halves, halves[::-1]):
            proposed = _proposals(x[:, moving], x[:, lending], sweep, draw)
            there = deviance(proposed)
            taken = np.log(draw.random(there.shape)) < (D[:, moving] - there) / 2
            x[:, moving] = np.where(taken[..., None], proposed, x[:, moving])
            D[:, moving] = np.where(taken, there, D[:, moving])
        if sweep >= sweeps // 2 and sweep % _KEEP_EVERY == 0:
            kept.append(x.copy())
    return np.array(kept)


def _proposals(x: Array, others: Array, sweep: int, draw: np.random.Generator) -> Array:
    """Proposals from x (S, k, unknowns); points outside the box re-enter on the other side.

    So a step and its opposite stay equally likely. Reflection at one side alone would turn a step
    across the valley, but not its opposite.
    """
    sets, count, size = x.shape
    lent = others.shape[1]
    first = draw.integers(lent, size=(sets, count))
    second = (first + draw.integers(1, lent, size=(sets, count))) % lent
    length = 2.38 / math.sqrt(2 * size) * draw.uniform(0.3, 1.1, (sets, count, 1))
    if sweep % _LONG_STEP_EVERY == 0:
        length = np.ones((sets, count, 1))
    row = np.arange(sets)[:, None]
    step = length * (others[row, first] - others[row, second])
    return (x + step + draw.normal(0, 1e-3, x.shape)) % 1.0


def _split_rhat(points: Array) -> float:
    """Split R-hat over kept sweeps (S, chains, unknowns), of the worst unknown."""
    half = len(points) // 2
    parts = np.concatenate([points[:half], points[-half:]], axis=1)
    within = parts.var(axis=0, ddof=1).mean(axis=0)
    between = parts.mean(axis=0).var(axis=0, ddof=1)
    return float(np.sqrt((half - 1) / half + between / within).max())
