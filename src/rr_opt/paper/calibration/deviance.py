"""How far nine predicted speeds are from nine measured ones: minus twice the log-likelihood.

With standard errors from n = 3 runs each row is Student's with 2 degrees of freedom,
3 log(1 + z^2/2) in z = (predicted - measured)/standard error; with standard errors taken as
known it is z^2. Both are 0 for a perfect fit.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration.measured import FREEDOM

Array = NDArray[np.float64]

Law = Literal["student", "normal"]


def row_deviance(z: Array, law: Law) -> Array:
    """The part of each row, in the shape of z; infinite where z is not a number."""
    square = np.where(np.isnan(z), np.inf, z) ** 2
    return square if law == "normal" else (FREEDOM + 1) * np.log1p(square / FREEDOM)


def weight(z: Array, law: Law) -> Array:
    """What a row counts in a least-squares step: the slope of its deviance in z^2."""
    return np.ones_like(z) if law == "normal" else (FREEDOM + 1) / (FREEDOM + z**2)
