"""Nine rows as a robot that is known would have given them: three runs a row, with scatter.

Models held against the nine rows: fit, what the fit costs in unknowns, and prediction.

A small deviance is no merit of a model with six unknowns and nine rows. So each model is also
charged for its unknowns (AICc), made to predict each row from the other eight, and its fit is
held against fits to data that it made itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_paper.calibration.fit import Fit, Library, descend, problems
from rr_paper.calibration.models import Law, Measured, one_way
from rr_paper.publication import RUNS


@dataclass(frozen=True)
class Simulated:
    """Means and standard errors of K data sets, (K, 9) each, m/s."""

    speed: Array
    error: Array

    def one(self, which: int) -> Measured:
        """A data set by itself."""
        return Measured(self.speed[which], self.error[which])


def simulated(truth: Array, data: Measured, draw: np.random.Generator) -> Simulated:
    """Data sets from true speeds (K, 9): the runs scatter as the paper's runs did, normally, and
    each set's standard errors come from its own three runs."""
    scatter = data.error * np.sqrt(RUNS)
    runs = truth + scatter * draw.standard_normal((RUNS, *truth.shape))
    return Simulated(runs.mean(axis=0), runs.std(axis=0, ddof=1) / np.sqrt(RUNS))


@dataclass(frozen=True)
class Charge:
    """What a fit with so many unknowns to so many rows is worth.

    freedom  rows less unknowns
    aicc     Akaike's criterion with the small-sample correction; None where it is undefined
    """

    rows: int
    unknowns: int
    deviance: float

    @property
    def freedom(self) -> int:
        """Degrees of freedom left."""
        return self.rows - self.unknowns

    @property
    def correction(self) -> float:
        """2K(K+1)/(n - K - 1); infinite where n - K - 1 is not positive."""
        left = self.rows - self.unknowns - 1
        return 2 * self.unknowns * (self.unknowns + 1) / left if left > 0 else math.inf

    @property
    def aicc(self) -> float | None:
        """D + 2K + the correction."""
        if math.isinf(self.correction):
            return None
        return self.deviance + 2 * self.unknowns + self.correction


def refits(
    predict: Callable[[Array], Array],
    sets: Simulated,
    starts: Sequence[Array],
    *,
    law: Law,
    steps: int,
    fixed: int | None = None,
) -> Array:
    """The least deviance of each set, (K,); starts: arrays (K, unknowns) or (unknowns,).

    fixed: an unknown that is held at its value in the starts.
    """
    count = len(sets.speed)
    size = starts[0].shape[-1]
    begin = np.concatenate([np.broadcast_to(one, (count, size)) for one in starts])
    repeat = (len(starts), 1)
    held = np.arange(size) == (-1 if fixed is None else fixed)
    posed = problems(
        lambda x: one_way(predict(x)),
        begin,
        np.tile(sets.speed, repeat),
        np.tile(sets.error, repeat),
        law=law,
        fixed=np.broadcast_to(held, begin.shape),
    )
    _, found = descend(posed, begin, steps)
    return found.reshape(len(starts), count).min(axis=0)


def nearest(known: Library, sets: Simulated, law: Law) -> Array:
    """The library's best point for each set, (K, unknowns)."""
    found = [int(known.deviance(sets.one(i), law).argmin()) for i in range(len(sets.speed))]
    return known.points[found]


@dataclass(frozen=True)
class Likelier:
    """How often data made by the smaller model look as bad for it as the paper's do.

    sets   how many were made
    worse  whose deviance is at least that of the paper's
    gained of them, how many the larger model improves by at least as much; None without one
    """

    sets: int
    worse: int
    gained: int | None


def likelier(
    small: tuple[Callable[[Array], Array], Library, Fit],
    large: tuple[Callable[[Array], Array], Library, Fit, Callable[[Array], Array]] | None,
    data: Measured,
    *,
    sets: int,
    law: Law = "student",
    steps: int = 12,
) -> Likelier:
    """small: predict, library and best fit; large: the same, and how a point of the small model
    is written in the large one, (K, small) -> (K, large)."""
    predict, known, best = small
    truth = np.broadcast_to(one_way(best.speeds[None])[0], (sets, len(best.speeds)))
    made = simulated(truth, data, np.random.default_rng(3))
    starts = [best.point, nearest(known, made, law)]
    own = refits(predict, made, starts, law=law, steps=steps)
    worse = int((own >= best.deviance).sum())
    if large is None:
        return Likelier(sets, worse, None)
    predict_more, known_more, more, lifted = large
    starts = [more.point, lifted(best.point[None])[0], nearest(known_more, made, law)]
    other = refits(predict_more, made, starts, law=law, steps=steps)
    gain = own - np.minimum(own, other)
    return Likelier(sets, worse, int((gain >= best.deviance - more.deviance).sum()))
