"""A sample of what the nine rows leave possible, each unknown flat inside its box beforehand.

The library's points, each with the weight of its likelihood, are drawn from; then the draws move
by differential evolution: a point steps along the difference of two others, which knows the
shape of the valley, and Metropolis' rule keeps the distribution. One half of the points moves
while the other lends the differences, so that each half's moves are reversible.

ter Braak (2006), Statistics and Computing 16, 239-249.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_paper.calibration.fit import Library
from rr_paper.calibration.models import Measured, one_way, row_deviance

_KEEP_EVERY = 5
_LONG_STEP_EVERY = 5
"""Now and then a step is a whole difference, which carries a point from one valley to another."""


@dataclass(frozen=True)
class Posterior:
    """points (N, unknowns), shares of the boxes; deviance (N,); speeds signed (N, 9), m/s.

    rhat            split R-hat of the worst unknown: near 1 if the chains agree
    library_weight  effective number of points of the library, which the draws started from
    """

    points: Array
    deviance: Array
    speeds: Array
    rhat: float
    library_weight: float

    def quantiles(self, at: tuple[float, ...] = (0.025, 0.5, 0.975)) -> Array:
        """Of each unknown, as shares of its box, (len(at), unknowns)."""
        return np.quantile(self.points, at, axis=0)


def weights(deviance: Array) -> Array:
    """Likelihoods (N,) that sum to 1."""
    w = np.exp(-(deviance - deviance.min()) / 2)
    return w / w.sum()


def sample(
    predict: Callable[[Array], Array],
    known: Library,
    data: Measured,
    *,
    chains: int,
    sweeps: int,
    tick: Callable[[], None],
) -> Posterior:
    """Draws from the posterior by Student's law; predict gives signed speeds. The first half of
    the sweeps is thrown away. tick: called before each sweep."""
    draw = np.random.default_rng(1)
    start = weights(known.deviance(data))
    x = known.points[draw.choice(len(start), chains, p=start)]
    kept = evolve(predict, x[None], data, sweeps, draw, tick)[:, 0]
    points = kept.reshape(-1, x.shape[1])
    speeds = predict(points)
    deviance = row_deviance((one_way(speeds) - data.speed) / data.error, "student").sum(axis=1)
    return Posterior(points, deviance, speeds, _split_rhat(kept), float(1 / (start**2).sum()))


def evolve(
    predict: Callable[[Array], Array],
    x: Array,
    data: Measured,
    sweeps: int,
    draw: np.random.Generator,
    tick: Callable[[], None],
) -> Array:
    """Sweeps of S data sets side by side, from chains x (S, C, unknowns).

    data: speeds and errors (S, 9), or (9,) for one set. Returns the chains at every fifth sweep
    of the second half, (kept, S, C, unknowns).
    """
    x, (sets, chains, size) = x.copy(), x.shape
    speed, error = (np.broadcast_to(part, (sets, 9))[:, None] for part in (data.speed, data.error))

    def deviance(points: Array) -> Array:
        z = (one_way(predict(points.reshape(-1, size))).reshape(sets, -1, 9) - speed) / error
        return row_deviance(z, "student").sum(axis=2)

    D, kept = deviance(x), []
    halves = slice(0, chains // 2), slice(chains // 2, chains)
    for sweep in range(sweeps):
        tick()
        for moving, lending in (halves, halves[::-1]):
            proposed = _proposals(x[:, moving], x[:, lending], sweep, draw)
            found = deviance(proposed)
            taken = np.log(draw.random(found.shape)) < (D[:, moving] - found) / 2
            x[:, moving] = np.where(taken[..., None], proposed, x[:, moving])
            D[:, moving] = np.where(taken, found, D[:, moving])
        if sweep >= sweeps // 2 and sweep % _KEEP_EVERY == 0:
            kept.append(x.copy())
    return np.array(kept)


def _proposals(x: Array, others: Array, sweep: int, draw: np.random.Generator) -> Array:
    """Where to go from x (S, k, unknowns); what leaves the box comes in on the other side.

    So a step and its opposite stay equally likely. Reflected at one side alone a step would turn
    against the valley, which its opposite does not.
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
