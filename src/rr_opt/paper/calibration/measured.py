"""The nine measured averages of Tables 2 and 3, and what their intervals mean.

An interval is mean +- t s/sqrt(n) with n = 3 runs and t the 97.5 % point of Student's
distribution with 2 degrees of freedom. So the standard error is half_width/4.303, and it is
itself estimated from three runs: (mean - true)/standard error follows Student's distribution
with 2 degrees of freedom, not the normal one.

The tables head the column with the interval as the mean and the other as `v_exp`. Both readings
of which column was measured are followed; the intervals are the same, there being one set.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

from rr_opt.paper.printed import RUNS, TABLE_2, TABLE_3

Array = NDArray[np.float64]

Column = Literal["mean", "other"]
COLUMNS: tuple[Column, ...] = ("mean", "other")

FREEDOM = RUNS - 1
"""Degrees of freedom of each standard error."""

T_POINT = float(student.ppf(0.975, FREEDOM))
"""t of the printed intervals: 4.303."""

ROWS = (*TABLE_2, *TABLE_3)
"""The nine rows, Table 2 first."""

RATIO = np.array([row.ratio for row in ROWS])
PERIOD = np.array([row.period for row in ROWS])
AMPLITUDE = np.array([np.nan if row.amplitude is None else row.amplitude for row in ROWS])
"""rad; NaN where the paper does not give it: there the unknown `amplitude` stands."""

LABELS = tuple(
    f"Table 2, ratio {row.ratio:g}"
    if row.amplitude is None
    else f"Table 3, T = {row.period:g} s, α = {row.amplitude:g}"
    for row in ROWS
)


@dataclass(frozen=True)
class Measured:
    """Nine speeds, m/s, and their standard errors, m/s; both (9,)."""

    speed: Array
    error: Array


def measured(column: Column) -> Measured:
    """What was measured, if `column` is the measured one."""
    speed = np.array([getattr(row, column) for row in ROWS])
    return Measured(speed, np.array([row.half_width for row in ROWS]) / T_POINT)
