"""The best fit of a model to nine rows, from many starts.

Points spread evenly over the boxes of a model, with the nine speeds of each.

Where to start a search, the weight of every region, and, as data enter only afterwards, the
same points serve any data.

Many small fits side by side: Levenberg and Marquardt's method on arrays of problems.

A profile, a bootstrap or a row left out each need hundreds of fits of five or six unknowns to
nine rows. Their predictions are cheap only in bulk, so all of them step together: one array of
points and their neighbours is predicted per step. Student's law enters as weights that follow
the residuals. A coordinate that stands on a side of the box and pulls outward is left there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from rr_opt.array import Array
from rr_paper.calibration.models import Law, Measured, Model, one_way, row_deviance, weight


@dataclass(frozen=True)
class Effort:
    """How much of everything.

    log2_size  of the library, as a power of two
    slices     of each unknown, from whose best points a fit starts
    values     of a profile, with `starts` starts at each
    steps      of a descent
    sets       of made data, against which a fit is held
    """

    log2_size: int
    slices: int
    values: int
    starts: int
    steps: int
    sets: int


_CHEAP = Effort(log2_size=15, slices=12, values=25, starts=2, steps=20, sets=200)
_DEARER = Effort(log2_size=13, slices=8, values=0, starts=0, steps=15, sets=0)
_DEAR = Effort(log2_size=12, slices=5, values=11, starts=2, steps=9, sets=40)

CHAINS, SWEEPS = 100, 2400
"""Of the posterior sample of the viscous model."""

COVERAGE_SETS = 100
"""Of made data whose intervals are held against the truth."""


def effort(model: Model) -> Effort:
    """For a model."""
    if model.cost > 10:
        return _DEAR
    return _DEARER if model.cost > 2 else _CHEAP


OTHERS = {"viscous": {"log2_size": 14}, "viscous+dry": {"log2_size": 11, "slices": 3}}
"""What is done less under the other readings of J20/J10, by model."""


_BLOCK = 4096
"""Points between two looks at whether the user has asked to stop."""


@dataclass(frozen=True)
class Library:
    """points (N, unknowns), shares of the boxes; speeds (N, 9), m/s, counted `one_way`."""

    points: Array
    speeds: Array

    def deviance(self, data: Measured, law: Law = "student") -> Array:
        """Of every point, (N,)."""
        return row_deviance((self.speeds - data.speed) / data.error, law).sum(axis=1)

    def best(self, data: Measured, law: Law, slices: int, counted: Array | None = None) -> Array:
        """The best point in each of so many slices of each unknown, (unknowns slices, unknowns).

        Where searches start: the best points of all would lie in one valley. counted: (9,), 1
        where a row counts and 0 where it is left out.
        """
        rows = row_deviance((self.speeds - data.speed) / data.error, law)
        deviance = rows.sum(axis=1) if counted is None else rows[:, counted > 0].sum(axis=1)
        of = np.minimum((self.points * slices).astype(int), slices - 1)
        found = []
        for unknown in range(self.points.shape[1]):
            for k in range(slices):
                inside = np.flatnonzero(of[:, unknown] == k)
                found.append(inside[np.argmin(deviance[inside])])
        return self.points[found]


def library(
    predict: Callable[[Array], Array], unknowns: int, log2_size: int, tick: Callable[[], None]
) -> Library:
    """2^log2_size points of Sobol's sequence; predict gives signed speeds. tick: called often."""
    points = qmc.Sobol(unknowns, rng=np.random.default_rng(0)).random_base2(log2_size)
    found = []
    for first in range(0, len(points), _BLOCK):
        tick()
        found.append(predict(points[first : first + _BLOCK]))
    speeds = np.concatenate(found)
    return Library(points, one_way(speeds))


_DIFFERENCE = 5e-3
"""Step of the difference quotients, as a share of the box: long enough that the steps of the
motion with dry friction, as coarse as the noise allows, do not show in them."""
_START, _SOFTER, _HARDER, _GIVE_UP = 1e-2, 0.2, 6.0, 1e6


@dataclass(frozen=True)
class Problems:
    """K problems over unknowns in [0, 1].

    predict  (N, unknowns) -> speeds (N, 9), counted as the printed ones are
    target, error  (K, 9), m/s
    counted  (K, 9), 1 where a row counts and 0 where it is left out
    fixed    (K, unknowns), True where an unknown is held
    """

    predict: Callable[[Array], Array]
    target: Array
    error: Array
    counted: Array
    fixed: NDArray[np.bool_]
    law: Law = "student"

    def deviance(self, speeds: Array, which: NDArray[np.int_]) -> Array:
        """Of predictions (k, 9) for the problems `which` (k,)."""
        z = (speeds - self.target[which]) / self.error[which]
        kept = self.counted[which] > 0
        return np.where(kept, row_deviance(z, self.law), 0.0).sum(axis=1)


def problems(
    predict: Callable[[Array], Array],
    start: Array,
    target: Array,
    error: Array,
    *,
    law: Law = "student",
    counted: Array | None = None,
    fixed: NDArray[np.bool_] | None = None,
) -> Problems:
    """One problem for each start (K, unknowns); target, error, counted and fixed broadcast."""
    rows = (len(start), np.shape(target)[-1])
    counted = np.ones(rows) if counted is None else counted
    fixed = np.zeros(start.shape, bool) if fixed is None else fixed
    return Problems(
        predict=predict,
        target=np.broadcast_to(target, rows),
        error=np.broadcast_to(error, rows),
        counted=np.broadcast_to(counted, rows),
        fixed=np.broadcast_to(fixed, start.shape),
        law=law,
    )


def descend(posed: Problems, start: Array, steps: int = 25) -> tuple[Array, Array]:
    """The points that the starts (K, unknowns) lead to, and their deviances (K,)."""
    x = start.copy()
    every = np.arange(len(x))
    speeds = posed.predict(x)
    best = posed.deviance(speeds, every)
    damping, going = np.full(len(x), _START), every[np.isfinite(best)]
    for _ in range(steps):
        if not len(going):
            break
        tried = _step(posed, x[going], speeds[going], damping[going], going)
        there = posed.predict(tried)
        found = posed.deviance(there, going)
        better = found < best[going]
        gain = best[going] - found
        won = going[better]
        x[won], speeds[won], best[won] = tried[better], there[better], found[better]
        damping[going] *= np.where(better, _SOFTER, _HARDER)
        finished = (better & (gain < 1e-5)) | (damping[going] > _GIVE_UP)
        going = going[~finished]
    return x, best


def _step(
    posed: Problems, x: Array, speeds: Array, damping: Array, which: NDArray[np.int_]
) -> Array:
    """The next points (k, unknowns), inside the box."""
    J = _slopes(posed.predict, x, speeds) / posed.error[which][:, :, None]
    z = (speeds - posed.target[which]) / posed.error[which]
    w = np.sqrt(weight(z, posed.law) * posed.counted[which])
    J, z = np.nan_to_num(J * w[:, :, None]), z * w
    downhill = -np.einsum("kri,kr->ki", J, z)
    outward = ((x <= 0) & (downhill < 0)) | ((x >= 1) & (downhill > 0))
    free = ~(posed.fixed[which] | outward)
    J, downhill = J * free[:, None, :], downhill * free
    normal = np.einsum("kri,krj->kij", J, J)
    diagonal = np.einsum("kii->ki", normal)
    ridge = damping[:, None] * (diagonal + 1e-3) + np.where(free, 0.0, 1.0)
    normal = normal + ridge[:, :, None] * np.eye(x.shape[1])
    return np.clip(x + np.linalg.solve(normal, downhill[:, :, None])[:, :, 0], 0.0, 1.0)


def _slopes(predict: Callable[[Array], Array], x: Array, speeds: Array) -> Array:
    """d speeds/dx by differences towards the box's middle, (k, 9, unknowns)."""
    size = x.shape[1]
    h = np.where(x < 0.5, _DIFFERENCE, -_DIFFERENCE)
    moved = x[:, None, :] + h[:, None, :] * np.eye(size)
    beside = predict(moved.reshape(-1, size)).reshape(len(x), size, -1)
    return np.moveaxis((beside - speeds[:, None, :]) / h[:, :, None], 1, 2)


@dataclass(frozen=True)
class Fit:
    """point (unknowns,), shares of the boxes; speeds signed (9,), m/s; deviance of the rows that
    counted."""

    point: Array
    speeds: Array
    deviance: float

    def z(self, data: Measured) -> Array:
        """How far each row is off, in standard errors, (9,)."""
        return (one_way(self.speeds[None])[0] - data.speed) / data.error


def fit(
    predict: Callable[[Array], Array],
    known: Library,
    data: Measured,
    *,
    law: Law,
    slices: int,
    steps: int,
    also: Array | None = None,
    counted: Array | None = None,
) -> Fit:
    """predict gives signed speeds. Starts are the library's best in each of so many slices of
    each unknown, and `also` (K, unknowns). counted: (9,), 0 where a row is left out."""
    begin = known.best(data, law, slices, counted)
    if also is not None:
        begin = np.concatenate([also, begin])
    posed = problems(
        lambda x: one_way(predict(x)), begin, data.speed, data.error, law=law, counted=counted
    )
    x, found = descend(posed, begin, steps)
    # Most starts end in side valleys: only the most promising go on to the bottom.
    front = np.argsort(found)[: max(1, len(found) // 4)]
    posed = problems(
        lambda x: one_way(predict(x)), x[front], data.speed, data.error, law=law, counted=counted
    )
    x, found = descend(posed, x[front], 2 * steps)
    best = int(found.argmin())
    return Fit(x[best], predict(x[best : best + 1])[0], float(found[best]))


def leave_one_out(
    predict: Callable[[Array], Array],
    known: Library,
    data: Measured,
    whole: Fit,
    *,
    law: Law,
    slices: int,
    steps: int,
) -> Array:
    """z (9,) of each row as predicted by a fit to the other eight."""
    counted = 1.0 - np.eye(len(data.speed))
    starts = [
        np.concatenate([whole.point[None], known.best(data, law, slices, row)]) for row in counted
    ]
    each = len(starts[0])
    begin = np.concatenate(starts)
    posed = problems(
        lambda x: one_way(predict(x)),
        begin,
        data.speed,
        data.error,
        law=law,
        counted=np.repeat(counted, each, axis=0),
    )
    x, found = descend(posed, begin, steps)
    best = found.reshape(-1, each).argmin(axis=1) + each * np.arange(len(counted))
    speeds = one_way(predict(x[best]))
    return (np.diag(speeds) - data.speed) / data.error
