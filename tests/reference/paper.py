"""Values printed in the paper, as printed, with the number of their table.

Experimental Investigations of the Controlled Motion of the Roller Racer Robot, in: D. Chugo
et al. (Eds.), CLAWAR 2021, LNNS 324, pp. 428-437 (2022).

Errata found when these were used:
- Table 1 gives no unit for kappa, and neither c, a, b nor h apart.
- Table 3 calls one column `v_exp`, yet the other, which has a confidence interval, can only be
  the measured one. Here they are called by their place: the first and the second.
- J20/J10 of Tables 2 and 3 is not I20/I10 of Table 1 (0.453); see `rr_opt.robot.ballast`.
"""

from typing import NamedTuple

TABLE_1 = {
    "greatest angle phi": (2.6, "rad"),
    "greatest rate dphi/dt": (30.0, "rpm"),
    "m1": (0.469, "kg"),
    "m2": (0.250, "kg"),
    "mass of one load": (0.066, "kg"),
    "I10": (0.00386, "kg m2"),
    "I20": (0.00175, "kg m2"),
    "c1 - a1": (0.186, "m"),
    "c2 - a2": (0.0441, "m"),
    "kappa": (0.25, None),
}
"""Table 1, the parameters of the prototype: (value, unit)."""


class RatioRow(NamedTuple):
    """A row of Table 2: speeds in m/s at T = 1 s and an amplitude that is not stated."""

    ratio: float
    first_speed: float
    half_width: float
    second_speed: float


TABLE_2 = (
    RatioRow(0.16, 0.1015, 0.056, 0.1057),
    RatioRow(0.18, 0.1659, 0.085, 0.1511),
    RatioRow(0.20, 0.2099, 0.096, 0.1954),
)
"""Table 2, the first series: speed against J20/J10; half_width of the 95 % interval."""


class GaitRow(NamedTuple):
    """A row of Table 3: period in s, amplitude in rad, speeds in m/s at J20/J10 = 0.3."""

    period: float
    amplitude: float
    first_speed: float
    half_width: float
    second_speed: float


TABLE_3 = (
    GaitRow(1, 0.262, 0.0181, 0.015, 0.027),
    GaitRow(1, 0.524, 0.1378, 0.046, 0.16),
    GaitRow(1, 0.785, 0.3473, 0.124, 0.45),
    GaitRow(2, 0.262, 0.0069, 0.006, 0.011),
    GaitRow(2, 0.524, 0.0348, 0.024, 0.023),
    GaitRow(2, 0.785, 0.0536, 0.014, 0.04),
)
"""Table 3, the second series: speed against period and amplitude."""
