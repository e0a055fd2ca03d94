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

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rr_opt.array import Array
from rr_paper.publication import ROWS, RUNS, Column

Distribution = Literal["student", "normal"]
"""Of a row's error."""

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
        """How far predicted speeds (..., 9) are off, in standard errors."""
        return (speeds - self.speed) / self.error

    def deviance(self, speeds: Array, distribution: Distribution = "student") -> Array:
        """Of predicted speeds (..., 9), summed over the rows."""
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
    """Signed speeds (..., 9) counted positive in the direction in which most of the sum drives.

    The tables do not say which platform leads, but the text mentions gaits that drive the opposite
    way and no printed speed has a minus sign, so all nine are taken to drive the same way. A row
    that drives the other way comes out negative, far from what is printed.
    """
    return speeds * np.sign(speeds.sum(axis=-1, keepdims=True))
