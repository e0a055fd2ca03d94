"""The best fit of a model to nine rows, from many starts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration.descend import descend, problems
from rr_opt.paper.calibration.deviance import Law
from rr_opt.paper.calibration.library import Library
from rr_opt.paper.calibration.measured import Measured
from rr_opt.paper.calibration.models import one_way

Array = NDArray[np.float64]


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
