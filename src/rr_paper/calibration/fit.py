"""The nine averages as data, and the likelihood of predicted speeds.

A printed interval is mean +- t s/sqrt(n) with n = 3 runs, so the standard error is
half_width/4.303, and it is itself estimated from three runs: (mean - true)/standard error follows
Student's t distribution with 2 degrees of freedom, not the normal one.

The deviance is minus twice the log-likelihood: of a row with z = (predicted - measured)/standard
error it is 3 log(1 + z^2/2) by Student's t, and z^2 by the normal distribution, which takes the
standard errors as known. Both are 0 for a perfect fit. Either column may be the measured one; the
intervals are the same, as only one set is printed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.stats import qmc

from rr_opt.array import Array
from rr_paper.publication import ROWS, RUNS, Column

Distribution = Literal["student", "normal"]
"""Error distribution of a row."""

_FREEDOM = RUNS - 1


@dataclass(frozen=True)
class Data:
    """Speeds of the nine rows and their standard errors, m/s: (9,), or (K, 9) for K data sets."""

    speed: Array
    error: Array

    def one(self, which: int) -> Data:
        """A data set by itself."""
        return Data(self.speed[which], self.error[which])

    def z(self, speeds: Array) -> Array:
        """Deviation of predicted speeds (..., 9), in standard errors."""
        return (speeds - self.speed) / self.error

    def deviance(self, speeds: Array, distribution: Distribution = "student") -> Array:
        """Deviance of predicted speeds (..., 9), summed over the rows."""
        return row_deviance(self.z(speeds), distribution).sum(axis=-1)


def measured(column: Column) -> Data:
    """The data, if `column` is the measured one."""
    return Data(
        np.array([row.speed(column) for row in ROWS]),
        np.array([row.standard_error for row in ROWS]),
    )


def simulated(truth: Array, data: Data, draw: np.random.Generator) -> Data:
    """Data sets from true speeds (K, 9): normal scatter as large as that of the paper's runs, and
    the standard errors of each set from its own three runs."""
    scatter = data.error * np.sqrt(RUNS)
    runs = truth + scatter * draw.standard_normal((RUNS, *truth.shape))
    return Data(runs.mean(axis=0), runs.std(axis=0, ddof=1) / np.sqrt(RUNS))


def row_deviance(z: Array, distribution: Distribution) -> Array:
    """The contribution of each row, in the shape of z; infinite where z is not a number."""
    square = np.where(np.isnan(z), np.inf, z) ** 2
    if distribution == "normal":
        return square
    return (_FREEDOM + 1) * np.log1p(square / _FREEDOM)


def weight(z: Array, distribution: Distribution) -> Array:
    """The weight of a row in a least-squares step: the slope of its deviance in z^2."""
    return np.ones_like(z) if distribution == "normal" else (_FREEDOM + 1) / (_FREEDOM + z**2)


def one_way(speeds: Array) -> Array:
    """Signed speeds (..., 9), positive in the direction of most of their sum.

    The tables do not say which platform leads, but the text mentions gaits that drive the opposite
    way and no printed speed has a minus sign, so all nine are assumed to drive the same way. A row
    that drives the other way comes out negative, far from the printed value.
    """
    return speeds * np.sign(speeds.sum(axis=-1, keepdims=True))


@dataclass(frozen=True)
class Effort:
    """The computational effort.

    log2_size  of the library, as a power of two
    slices     of each unknown, whose best points are starts of a fit
    values     of a profile, with `starts` starts at each
    steps      of a descent
    sets       of simulated data in a bootstrap
    """

    log2_size: int
    slices: int
    values: int
    starts: int
    steps: int
    sets: int


@dataclass(frozen=True)
class Fit:
    """point (unknowns,), shares of the boxes; speeds signed (9,), m/s; deviance of the included
    rows."""

    point: Array
    speeds: Array
    deviance: float

    def z(self, data: Data) -> Array:
        """Deviation of each row, in standard errors, (9,)."""
        return data.z(one_way(self.speeds))


@dataclass(frozen=True)
class Estimator:
    """A model with its library.

    signed   points (N, unknowns), shares of the boxes -> signed speeds (N, 9), m/s
    points   (N, unknowns), of the library; speeds (N, 9), counted one way
    """

    signed: Callable[[Array], Array]
    effort: Effort
    points: Array
    speeds: Array

    def predict(self, points: Array) -> Array:
        """Speeds counted one way, (N, 9)."""
        return one_way(self.signed(points))

    def fit(
        self,
        data: Data,
        distribution: Distribution = "student",
        also: Array | None = None,
        counted: Array | None = None,
    ) -> Fit:
        """The best fit, with the additional starts `also` (K, unknowns).

        counted: (9,), 0 where a row is left out.
        """
        starts = self._starts(data, distribution, self.effort.slices, counted)
        if also is not None:
            starts = np.concatenate([also, starts])
        steps, options = self.effort.steps, {"distribution": distribution, "counted": counted}
        x, deviance = descend(self.predict, starts, data, steps, **options)
        # Most starts end in side valleys: only the most promising are run to convergence.
        front = np.argsort(deviance)[: max(1, len(deviance) // 4)]
        x, deviance = descend(self.predict, x[front], data, 2 * steps, **options)
        best = int(deviance.argmin())
        return Fit(x[best], self.signed(x[best : best + 1])[0], float(deviance[best]))

    def leave_one_out(self, data: Data, whole: Fit, distribution: Distribution) -> Array:
        """z (9,) of each row as predicted by a fit to the other eight."""
        counted = 1.0 - np.eye(len(data.speed))
        slices = max(1, self.effort.slices // 4)
        starts = [
            np.concatenate([whole.point[None], self._starts(data, distribution, slices, row)])
            for row in counted
        ]
        each = len(starts[0])
        x, deviance = descend(
            self.predict, np.concatenate(starts), data, self.effort.steps,
            distribution=distribution, counted=np.repeat(counted, each, axis=0),
        )  # fmt: skip
        best = deviance.reshape(-1, each).argmin(axis=1) + each * np.arange(len(counted))
        return np.diag(data.z(self.predict(x[best])))

    def refit(
        self,
        sets: Data,
        starts: Sequence[Array],
        distribution: Distribution,
        steps: int,
        fixed: int | None = None,
    ) -> Array:
        """The least deviance of each of K data sets, (K,).

        starts: arrays (K, unknowns) or (unknowns,); fixed: an unknown that stays at its value there
        """
        count, size = len(sets.speed), self.points.shape[1]
        begin = np.concatenate([np.broadcast_to(one, (count, size)) for one in starts])
        tiled = (np.tile(part, (len(starts), 1)) for part in (sets.speed, sets.error))
        held = None if fixed is None else np.arange(size) == fixed
        _, deviance = descend(
            self.predict, begin, Data(*tiled), steps, distribution=distribution, fixed=held
        )
        return deviance.reshape(len(starts), count).min(axis=0)

    def nearest(self, sets: Data, distribution: Distribution) -> Array:
        """The library's best point for each of K data sets, (K, unknowns)."""
        best = [
            int(sets.one(i).deviance(self.speeds, distribution).argmin())
            for i in range(len(sets.speed))
        ]
        return self.points[best]

    def _starts(
        self, data: Data, distribution: Distribution, slices: int, counted: Array | None
    ) -> Array:
        """The library's best point in each slice of each unknown, (unknowns slices, unknowns).

        The overall best points would all lie in one valley.
        """
        rows = row_deviance(data.z(self.speeds), distribution)
        deviance = rows.sum(axis=1) if counted is None else rows[:, counted > 0].sum(axis=1)
        slice_of = np.minimum((self.points * slices).astype(int), slices - 1)
        best = []
        for unknown in range(self.points.shape[1]):
            for k in range(slices):
                inside = np.flatnonzero(slice_of[:, unknown] == k)
                best.append(inside[np.argmin(deviance[inside])])
        return self.points[best]


def estimator(signed: Callable[[Array], Array], unknowns: int, effort: Effort) -> Estimator:
    """With 2^log2_size points of Sobol's sequence."""
    sobol = qmc.Sobol(unknowns, rng=np.random.default_rng(0))
    points = sobol.random_base2(effort.log2_size)
    return Estimator(signed, effort, points, one_way(signed(points)))


_DIFFERENCE = 5e-3
"""Step of the difference quotients, as a share of the box: large compared with the integration
errors of the motion with dry friction, which is only as accurate as the noise requires."""
_DAMPING, _SOFTER, _HARDER, _GIVE_UP = 1e-2, 0.2, 6.0, 1e6


def descend(
    predict: Callable[[Array], Array],
    starts: Array,
    data: Data,
    steps: int,
    *,
    distribution: Distribution = "student",
    counted: ArrayLike | None = None,
    fixed: ArrayLike | None = None,
) -> tuple[Array, Array]:
    """The local optima reached from the starts (K, unknowns), and their deviances (K,).

    predict  points (N, unknowns) -> speeds (N, 9), counted one way
    data     one set for all starts, or K of them
    counted  broadcasts to (K, 9): 0 where a row is left out
    fixed    broadcasts to (K, unknowns): True where an unknown stays at its value
    """
    rows = (len(starts), data.speed.shape[-1])
    data = Data(np.broadcast_to(data.speed, rows), np.broadcast_to(data.error, rows))
    kept = np.broadcast_to(True if counted is None else np.asarray(counted) > 0, rows)
    held = np.broadcast_to(False if fixed is None else np.asarray(fixed), starts.shape)

    def deviance(speeds: Array, which: NDArray[np.int_]) -> Array:
        z = (speeds - data.speed[which]) / data.error[which]
        return np.where(kept[which], row_deviance(z, distribution), 0.0).sum(axis=1)

    x, every = starts.copy(), np.arange(len(starts))
    speeds = predict(x)
    best = deviance(speeds, every)
    damping, going = np.full(len(x), _DAMPING), every[np.isfinite(best)]
    for _ in range(steps):
        if not len(going):
            break
        error = data.error[going]
        z = (speeds[going] - data.speed[going]) / error
        w = np.sqrt(weight(z, distribution) * kept[going])
        J = _slopes(predict, x[going], speeds[going]) / error[:, :, None]
        tried = _step(x[going], J * w[:, :, None], z * w, held[going], damping[going])
        there = predict(tried)
        reached = deviance(there, going)
        gain = best[going] - reached
        better = reached < best[going]
        won = going[better]
        x[won], speeds[won], best[won] = tried[better], there[better], reached[better]
        damping[going] *= np.where(better, _SOFTER, _HARDER)
        finished = (better & (gain < 1e-5)) | (damping[going] > _GIVE_UP)
        going = going[~finished]
    return x, best


def _step(x: Array, J: Array, z: Array, held: NDArray[np.bool_], damping: Array) -> Array:
    """The next points (k, unknowns), inside the box, from weighted slopes and residuals."""
    J = np.nan_to_num(J)
    downhill = -np.einsum("kri,kr->ki", J, z)
    outward = ((x <= 0) & (downhill < 0)) | ((x >= 1) & (downhill > 0))
    free = ~(held | outward)
    J, downhill = J * free[:, None, :], downhill * free
    normal = np.einsum("kri,krj->kij", J, J)
    diagonal = np.einsum("kii->ki", normal)
    ridge = damping[:, None] * (diagonal + 1e-3) + np.where(free, 0.0, 1.0)
    normal = normal + ridge[:, :, None] * np.eye(x.shape[1])
    return np.clip(x + np.linalg.solve(normal, downhill[:, :, None])[:, :, 0], 0.0, 1.0)


def _slopes(predict: Callable[[Array], Array], x: Array, speeds: Array) -> Array:
    """d speeds/dx by differences towards the middle of the box, (k, 9, unknowns)."""
    size = x.shape[1]
    h = np.where(x < 0.5, _DIFFERENCE, -_DIFFERENCE)
    moved = x[:, None, :] + h[:, None, :] * np.eye(size)
    beside = predict(moved.reshape(-1, size)).reshape(len(x), size, -1)
    return np.moveaxis((beside - speeds[:, None, :]) / h[:, :, None], 1, 2)
