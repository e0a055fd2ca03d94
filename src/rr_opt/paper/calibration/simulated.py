"""Nine rows as a robot that is known would have given them: three runs a row, with scatter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration.measured import Measured
from rr_opt.paper.printed import RUNS

Array = NDArray[np.float64]


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
