"""Points spread evenly over the boxes of a model, with the nine speeds of each.

Where to start a search, the weight of every region, and, as data enter only afterwards, the
same points serve any data.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from rr_opt.paper.calibration.deviance import Law, row_deviance
from rr_opt.paper.calibration.measured import Measured
from rr_opt.paper.calibration.models import one_way

Array = NDArray[np.float64]

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
