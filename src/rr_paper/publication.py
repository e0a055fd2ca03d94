"""The numbers that the paper prints, as printed, each in one place.

Experimental Investigations of the Controlled Motion of the Roller Racer Robot, in: D. Chugo
et al. (Eds.), CLAWAR 2021, LNNS 324, pp. 428-437 (2022). Tables 1-3 and Figs. 3-6 are in its
section 3.

Known errata and omissions:
- Table 1 gives no unit for kappa, no b and no h, and c - a instead of c and a.
- Tables 2 and 3 head one column `v_exp`, but only the other column has a confidence interval, so
  that one must have been measured. Here the first is `mean` and the second `other`.
- Table 2 does not state its amplitude.
- J20/J10 of Tables 2 and 3 is not I20/I10 of Table 1 (0.453); see `rr_opt.model.ballast`.
- Section 3.1 sets J20/J10 to 0.08, 0.14, 0.17, 0.19 and 0.2; Table 2 has 0.16, 0.18 and 0.2.
- The signs of equation (3) contradict equations (1), (2) and (4); see `rr_paper.equation3`.

The points of the paper's figures are not printed as numbers, so none of them is here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

from scipy.special import stdtrit

CITATION = (
    "Kilin, Karavaev, Yefremov: Experimental Investigations of the Controlled Motion of the "
    "Roller Racer Robot. CLAWAR 2021, LNNS 324, pp. 428-437 (2022)"
)


class Value(NamedTuple):
    """A number of Table 1 with its unit; None where the table prints none."""

    value: float
    unit: str | None


TABLE_1 = {
    "greatest angle phi": Value(2.6, "rad"),
    "greatest rate dphi/dt": Value(30.0, "rpm"),
    "m1": Value(0.469, "kg"),
    "m2": Value(0.250, "kg"),
    "mass of one load": Value(0.066, "kg"),
    "I10": Value(0.00386, "kg m2"),
    "I20": Value(0.00175, "kg m2"),
    "c1 - a1": Value(0.186, "m"),
    "c2 - a2": Value(0.0441, "m"),
    "kappa": Value(0.25, None),
}
"""Table 1, the parameters of the prototype."""

ANGLE_LIMIT = TABLE_1["greatest angle phi"].value
"""Table 1's largest servo angle, rad."""
RPM = 30 / math.pi
"""1 rad/s in rpm."""
RATE_LIMIT = TABLE_1["greatest rate dphi/dt"].value * 2 * math.pi / 60
"""Table 1's largest servo rate, 30 rpm in rad/s."""

RUNS = 3
"""Runs behind each row of Tables 2 and 3 (section 3.1: "sample size - 3")."""
T_POINT = float(stdtrit(RUNS - 1, 0.975))
"""The 97.5 % point of Student's t, 4.303: the printed half widths are t s/sqrt(n)."""

Column = Literal["mean", "other"]
COLUMNS: tuple[Column, ...] = ("mean", "other")
"""The two speed columns. Which of them was measured is unclear."""


@dataclass(frozen=True)
class Row:
    """A row of Table 2 or 3.

    ratio       J20/J10
    period      T, s
    amplitude   alpha, rad; None where the paper does not state it
    mean        the column with the interval, m/s; by its head the mean of n = 3 runs
    half_width  of the 95 % interval, t s/sqrt(n), m/s
    other       the column headed v_exp, m/s
    """

    ratio: float
    period: float
    amplitude: float | None
    mean: float
    half_width: float
    other: float

    @property
    def standard_error(self) -> float:
        """Standard error of the mean, m/s, itself estimated from three runs."""
        return self.half_width / T_POINT

    def speed(self, column: Column) -> float:
        """The speed in a column, m/s."""
        return self.mean if column == "mean" else self.other


TABLE_2 = (
    Row(0.16, 1.0, None, 0.1015, 0.056, 0.1057),
    Row(0.18, 1.0, None, 0.1659, 0.085, 0.1511),
    Row(0.20, 1.0, None, 0.2099, 0.096, 0.1954),
)
"""Table 2, the first series. T = 1 s is the text's (section 3.1)."""

TABLE_3 = (
    Row(0.3, 1.0, 0.262, 0.0181, 0.015, 0.027),
    Row(0.3, 1.0, 0.524, 0.1378, 0.046, 0.16),
    Row(0.3, 1.0, 0.785, 0.3473, 0.124, 0.45),
    Row(0.3, 2.0, 0.262, 0.0069, 0.006, 0.011),
    Row(0.3, 2.0, 0.524, 0.0348, 0.024, 0.023),
    Row(0.3, 2.0, 0.785, 0.0536, 0.014, 0.04),
)
"""Table 3, the second series. J20/J10 = 0.3 is the text's (section 3.1)."""

ROWS = (*TABLE_2, *TABLE_3)
"""All nine rows, Table 2 first."""


@dataclass(frozen=True)
class Surface:
    """The ranges of a surface plot, ends included: amplitude (rad), J20/J10 and period (s)."""

    amplitude: tuple[float, float]
    ratio: tuple[float, float]
    period: tuple[float, float]


FIGURE_4 = Surface(amplitude=(0.0, 1.4), ratio=(0.08, 0.2), period=(1.0, 1.0))
"""Fig. 4: average speed over J20/J10 and amplitude at T = 1 s. The text has 0.08 to 0.2."""
FIGURE_5 = Surface(amplitude=(0.0, 1.2), ratio=(0.3, 0.3), period=(0.8, 2.0))
"""Fig. 5: average speed over period and amplitude at J20/J10 = 0.3."""

LOADED_RATIOS = (0.08, 0.14, 0.17, 0.19, 0.2)
"""J20/J10 "by attachment of the additional loads" (section 3.1)."""
RATIOS = tuple(sorted({*LOADED_RATIOS, *(row.ratio for row in ROWS)}))
"""Every J20/J10 that the paper prints."""


@dataclass(frozen=True)
class Circles:
    """The gaits of Fig. 6: amplitude in rad, period in s, ratio J20/J10, offsets phi0 in rad."""

    amplitude: float
    period: float
    ratio: float
    offsets: tuple[float, ...]


FIGURE_6 = Circles(0.52, 1.0, 0.3, (0.0873, 0.174533, 0.261799))
"""Fig. 6: trajectories with an offset (section 3.2)."""

BEST_AMPLITUDE = 1.0
"""rad: speed increases with amplitude "up to a certain value (about 1 rad, for our prototype)"."""
