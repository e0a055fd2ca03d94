"""The robots of the nine rows: Table 1 with the unknowns filled in and the row's J20/J10.

The paper does not say how its ratios are taken. A `Reading` is one way to take them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration.measured import RATIO
from rr_opt.paper.printed import TABLE_1
from rr_opt.robot.ballast import About, By, Loads, hang

Array = NDArray[np.float64]

_M1, _M2 = TABLE_1["m1"].value, TABLE_1["m2"].value
_I1, _I2 = TABLE_1["I10"].value, TABLE_1["I20"].value
REACH1, REACH2 = TABLE_1["c1 - a1"].value, TABLE_1["c2 - a2"].value
"""From P to the centres of mass, m."""

WHEEL_RADIUS = 0.02
"""m; does not matter, as k is given and not kappa."""


@dataclass(frozen=True)
class Reading:
    """How J20/J10 is taken: about which point, and by what it was changed.

    spread  of the loads to either side of platform 2's axis, m
    """

    about: About = "joint"
    by: By = "loads"
    spread: float = Loads.spread

    @property
    def words(self) -> str:
        """The reading as a person says it."""
        point = "the joint P" if self.about == "joint" else "each centre of mass"
        if self.by == "inertia":
            return f"about {point}, I20 alone changed"
        return f"about {point}, by loads {1e3 * self.spread:.0f} mm off the axis"


READINGS = (
    Reading(),
    Reading(spread=0.1),
    Reading(by="inertia"),
    Reading(about="centre", by="inertia"),
)
"""The first is the default. About the centres of mass loads cannot do it: the bare robot has
I20/I10 = 0.453, above every ratio printed, and loads only add to it."""


def parameters(unknowns: Mapping[str, Array], reading: Reading) -> Array:
    """The 13 values of `rr_opt.physics.kinematics.ROBOT_PARAMETERS` for K points and 9 rows.

    unknowns: a1, a2, b (m) and k (N s/m), (K,) each. Returns (13, 9 K), rows of a point together.
    """
    count = len(unknowns["a1"])
    a1, a2, b, k = (unknowns[name][:, None] for name in ("a1", "a2", "b", "k"))
    m2, I2, reach2 = platform2(reading)
    c2 = REACH2 + a2
    columns = (
        *(_M1, _I1, REACH1 + a1, a1, b, k),
        *(m2, I2, c2, c2 - reach2, b, k),
        WHEEL_RADIUS,
    )
    return np.array([np.broadcast_to(column, (count, len(RATIO))).ravel() for column in columns])


def platform2(reading: Reading) -> tuple[Array, Array, Array]:
    """m (kg), I (kg m2) and distance from P to the centre of mass (m) in each row, (9,)."""
    ones = np.ones_like(RATIO)
    if reading.by == "inertia":
        if reading.about == "centre":
            return _M2 * ones, RATIO * _I1, REACH2 * ones
        return _M2 * ones, RATIO * (_I1 + _M1 * REACH1**2) - _M2 * REACH2**2, REACH2 * ones
    each = Loads(mass=TABLE_1["mass of one load"].value, distance=REACH2, spread=reading.spread)
    return hang(_M2, _I2, REACH2, each.each, load_counts(reading))


def load_counts(reading: Reading) -> Array:
    """How many loads, real numbers (9,), bring the joint inertia to each row's ratio."""
    mass = TABLE_1["mass of one load"].value
    wanted = RATIO * (_I1 + _M1 * REACH1**2)
    return (wanted - _I2 - _M2 * REACH2**2) / (mass * (REACH2**2 + reading.spread**2))
