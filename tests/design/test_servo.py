"""A gait is optimised with what the servo makes of its command."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.machines.racer.driven import drive_optimum, driven_speed
from rr_opt.model.gait import FourierGait, FreeGait, SineGait
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.model.robot import EffectUse
from rr_opt.model.servo_command import LinearServo
from rr_opt.motion.servo import servo_drive, servo_made
from tests.robots import BENCHMARK

SERVOS = {
    "servo_lag": {"tau": 0.08},
    "second order": {"tau": 0.05, "beta": 2e-3},
    "servo_offset": {"offset": 0.07},
    "servo_rate_limit": {"rate_limit": 2.0},
}


def with_effect(name, values):
    name = {"second order": "servo_lag"}.get(name, name)
    return replace(BENCHMARK, physics=(EffectUse(name, values),))


@pytest.mark.parametrize(
    "gait",
    [
        SineGait(0.5, 1.2, 0.1),
        FourierGait(0.9, -0.1, (0.4, 0.1), (0.0, 0.05)),
        FreeGait(1.0, 0.0, 0.5, (-2.0, -2.0, 2.0, 2.0)),
    ],
)
def test_what_a_servo_is_told_makes_the_gait(gait):
    servo = LinearServo(0.05, 2e-3, 0.03)
    made, t = servo.response_to(servo.command_for(gait)), np.linspace(0, 2, 301)
    if isinstance(gait, SineGait):  # told without its lead in time
        assert (made.amplitude, made.offset) == pytest.approx((gait.amplitude, gait.offset))
    else:
        assert np.allclose(made.angle(t), gait.angle(t), atol=1e-5)


@pytest.mark.parametrize("name", SERVOS)
def test_a_linear_servo_is_what_the_effect_is(name):
    robot, gait = with_effect(name, SERVOS[name]), SineGait(0.3, 1.0, 0.1)
    t = 20 + np.linspace(0, 1, 101)
    assert np.allclose(
        servo_made(robot, gait).angle(t), servo_drive(robot, gait).at(t)[0], atol=1e-6
    )


def test_the_order_in_which_a_robot_lists_its_effects_is_of_no_account():
    values = {**SERVOS, "servo_backlash": {"width": 0.1}}
    names = ["servo_lag", "servo_rate_limit", "servo_backlash", "servo_offset"]
    t, paths = np.linspace(0, 2, 201), []
    for listed in (names, sorted(names)):
        uses = tuple(EffectUse(name, values[name]) for name in listed)
        paths.append(
            servo_drive(replace(BENCHMARK, physics=uses), SineGait(0.6, 1.0, 0.1)).at(t)[0]
        )
    np.testing.assert_array_equal(*paths)


@pytest.mark.parametrize("name", SERVOS)
def test_the_robot_reaches_the_speed_with_its_servo(name):
    problem = Problem(with_effect(name, SERVOS[name]), gait=GaitBounds(offset=Interval(-0.2, 0.2)))
    found = maximize_speed(problem)
    told = found.problem.command.servo.command_for(found.best.gait)
    seen = driven_speed(problem.robot, told)
    assert seen.speed == pytest.approx(found.best.speed, rel=1e-5)
    assert problem.limits.worst(seen.reached)[1] <= 1e-6


def test_the_bounds_are_those_of_the_command():
    robot = with_effect("servo_lag", SERVOS["servo_lag"])

    def best(high):
        gait = GaitBounds(amplitude=Interval(0.05, high), period=Interval(0.3, 1.5))
        found = maximize_speed(Problem(robot, gait=gait))
        return found, found.problem.command.servo.command_for(found.best.gait)

    found, told = best(0.5)
    assert told.amplitude == pytest.approx(0.5, rel=1e-6)
    assert found.best.gait.amplitude < 0.45
    more, less = (abs(best(0.5 + step)[0].best.speed) for step in (1e-3, -1e-3))
    assert found.best.bound_prices["amplitude"] == pytest.approx((more - less) / 2e-3, rel=1e-2)


def test_play_is_climbed_on_with():
    """Dry friction in the joint takes from the swing, which longer periods lose less of."""
    values = {"width": 0.1, "joint_friction": 2.0}
    found = maximize_speed(Problem(with_effect("servo_backlash", values)))
    driven = drive_optimum(found)
    assert driven.beyond == ("servo_backlash",)
    assert abs(driven.driven.speed) >= abs(driven.start.speed)
    assert driven.driven.speed != pytest.approx(found.best.speed, rel=0.01)
    for change in (0.97, 1.03):
        gait = driven.gait
        period = max(gait.period * change, 0.3)
        amplitude = min(gait.amplitude * period / gait.period, 0.5 * period)
        other = driven_speed(driven.robot, replace(gait, amplitude=amplitude, period=period))
        assert abs(other.speed) <= abs(driven.driven.speed) * (1 + 1e-4)
