"""What looks like Coulomb friction: the power that it takes, from the motion of the platforms."""

from dataclasses import replace
from math import exp, hypot

import pytest
from hypothesis import assume, given

from tests.mechanics.cases import REPEATABLE, cases, energy, wheel_speeds


def power_of(robot, state):
    kinetic, dissipation = energy(robot, state)
    bare_kinetic, viscous = energy(replace(robot, physics=()), state)
    assert kinetic == pytest.approx(bare_kinetic, rel=1e-12)
    return dissipation - viscous


@REPEATABLE
@given(cases(("stribeck_friction",)))
def test_friction_that_falls_with_speed(case):
    robot, state = case
    own, speeds = robot.physics[0].values, wheel_speeds(robot, state)
    assume(min(abs(u) for u in speeds.values()) > 0.04)

    def force(platform, u):
        left = own["sliding"] + (1 - own["sliding"]) * exp(-((u / own["speed"]) ** 2))
        return own[f"force{platform}"] * left

    power = sum(force(platform, u) * abs(u) for (platform, _), u in speeds.items())
    assert power_of(robot, state) == pytest.approx(power, rel=1e-9, abs=1e-12)


@REPEATABLE
@given(cases(("dragged_cable",)))
def test_a_cable_acts_against_the_velocity_of_its_point(case):
    robot, state = case
    own, speeds, power = robot.physics[0].values, wheel_speeds(robot, state), 0.0
    for i, platform in ((1, robot.platform1), (2, robot.platform2)):
        left, right = speeds[i, 1], speeds[i, -1]
        along, turning = (left + right) / 2, (right - left) / (2 * platform.b)
        speed = hypot(along, own[f"distance{i}"] * turning)
        assume(speed > 0.2)
        power += own[f"force{i}"] * speed
    assert power_of(robot, state) == pytest.approx(power, rel=1e-4, abs=1e-12)
