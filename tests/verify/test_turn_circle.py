"""The circle's check passes the true curvature and no other, straight or not, any friction."""

import math

import pytest

from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot, Servo
from rr_opt.motion.circle import circle_of
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.verify.replay import check_circle
from tests.robots import BENCHMARK, DRY


@pytest.mark.parametrize("robot", [BENCHMARK, DRY], ids=["viscous", "dry"])
@pytest.mark.parametrize("offset", [0.4, -0.05, 1e-9])
def test_the_true_curvature_passes(robot, offset):
    gait = SineGait(0.7, 1.4, offset)
    curvature = circle_of(steady_cycle(robot, gait).cycle).curvature
    check = check_circle(robot, gait, curvature)
    assert check.passed
    assert check.ends < 1e-5


def test_another_does_not():
    gait = SineGait(0.7, 1.4, 0.4)
    curvature = circle_of(steady_cycle(BENCHMARK, gait).cycle).curvature
    check = check_circle(BENCHMARK, gait, curvature * (1 + 2e-4))
    assert not check.passed
    assert check.mean == pytest.approx(2e-4, rel=1e-2)


def test_a_robot_that_turns_on_the_spot_is_followed_until_it_is_settled():
    first = Platform(0.3184, 0.001368, 0.1581, 0.005519, 0.05396, 2.57e-06)
    second = Platform(0.3137, 0.01106, 0.06508, 0.0009167, 0.06292, 6.7254e-06)
    robot = Robot(first, second, 0.016, Servo(2.6, math.pi, 1.37))
    gait = SineGait(0.97128, 0.90505, -0.4275)
    circle = circle_of(steady_cycle(robot, gait).cycle)
    assert circle.radius < 0.02
    assert check_circle(robot, gait, circle.curvature).rest < 1e-5
