"""The posterior of the unknowns: a flat prior inside each box, sampled.

Points of the library, weighted by their likelihood, are drawn as a start. Then they move by
differential evolution (ter Braak 2006, Statistics and Computing 16, 239-249): a point steps along
the difference of two others, which follows the shape of the valley, and Metropolis' rule keeps the
distribution. One half of the points moves while the other lends the differences, so that each
half's moves are reversible.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_paper.calibration.fit import Estimator
from rr_paper.calibration.likelihood import Data

_KEEP_EVERY = 5
_LONG_STEP_EVERY = 5
"""Now and then a step is a whole difference, which carries a point from one valley to another."""


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


def sample(
    estimator: Estimator, data: Data, *, chains: int, sweeps: int, tick: Callable[[], None]
) -> Posterior:
    """Draws from the posterior by Student's t, of the second half of the sweeps."""
    draw = np.random.default_rng(1)
    x, weight = library_draws(estimator, data, chains, draw)
    kept = evolve(estimator, x[None], data, sweeps, draw, tick)[:, 0]
    points = kept.reshape(-1, x.shape[1])
    deviance = data.deviance(estimator.predict(points))
    return Posterior(points, deviance, _split_rhat(kept), weight)


def evolve(
    estimator: Estimator,
    x: Array,
    data: Data,
    sweeps: int,
    draw: np.random.Generator,
    tick: Callable[[], None],
) -> Array:
    """Sweeps of S data sets side by side, from chains x (S, C, unknowns).

    Returns the chains at every fifth sweep of the second half, (kept, S, C, unknowns).
    tick: called before each sweep.
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
        tick()
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
    """Where to go from x (S, k, unknowns); what leaves the box re-enters on the other side.

    So a step and its opposite stay equally likely. Reflected at one side alone a step would turn
    across the valley, and its opposite would not.
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
