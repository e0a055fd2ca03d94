"""Wheels that differ take k (1 + asymmetry) u^2 on the left and k (1 - asymmetry) u^2 on the right.

The mean friction of a pair stays.
"""

import pytest
from hypothesis import given

from tests.mechanics.cases import REPEATABLE, cases, energy, wheel_speeds


@REPEATABLE
@given(cases(("left_right_drag",)))
def test_power_at_the_wheels(case):
    robot, state = case
    k, values = (robot.k1, robot.k2), robot.physics[0].values
    power = sum(
        k[number - 1] * (1 + side * values[f"asymmetry{number}"]) * u**2
        for (number, side), u in wheel_speeds(robot, state).items()
    )
    assert energy(robot, state)[1] == pytest.approx(power, rel=1e-9, abs=1e-12)
