"""Each wheel rolls as its axle does, the left one slower by b w and the right one faster.

On a robot whose wheels are alike nothing else tells left from right.
"""

import casadi as ca
import pytest
from hypothesis import given

from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS, mechanism, robot_values
from tests.mechanics.cases import REPEATABLE, cases, wheel_speeds

MECHANISM = mechanism()
SPEEDS = ca.Function(
    "speeds",
    [
        MECHANISM.speeds,
        MECHANISM.phi,
        ca.vertcat(*(MECHANISM.parameters[name] for name in ROBOT_PARAMETERS)),
    ],
    [ca.vertcat(*(MECHANISM.rolling_speed(wheel) for wheel in MECHANISM.wheels))],
)


@REPEATABLE
@given(cases())
def test_left_is_left(case):
    robot, state = case
    found = SPEEDS([state.v, 0.0, 0.0, state.dphi], state.phi, robot_values(robot))
    names = [(wheel.platform, wheel.side) for wheel in MECHANISM.wheels]
    by_name = dict(zip(names, found.full().ravel(), strict=True))
    assert by_name == pytest.approx(wheel_speeds(robot, state), rel=1e-10, abs=1e-12)
