"""Wheel inertia is a change of parameters, exactly, for motion, torque and kinetic energy.

The two wheels of an axle at u -+ b w hold J/2 sum (u -+ b w)^2/h^2 = mu/2 (u^2 + b^2 w^2) with
mu = 2 J/h^2. As the axle does not slip, that is a point mass mu at its centre C and a moment of
inertia mu b^2. Joined to the platform, whose centre of mass is at a from C:

    m -> m + mu     a -> a m/(m + mu)     I -> I + m mu/(m + mu) a^2 + mu b^2
"""

from dataclasses import replace

import pytest
from hypothesis import given

from rr_opt.model.robot import Platform
from tests.mechanics.cases import REPEATABLE, cases, energy, motion


def heavier(platform: Platform, mu: float) -> Platform:
    m, a, b = platform.m, platform.a, platform.b
    inertia = platform.I + m * mu / (m + mu) * a**2 + mu * b**2
    return replace(platform, m=m + mu, a=a * m / (m + mu), I=inertia)


@REPEATABLE
@given(cases(("wheel_inertia",)))
def test_heavier_platforms_move_alike(case):
    robot, state = case
    mu = 2 * robot.physics[0].values["J"] / robot.h**2
    one, two = heavier(robot.platform1, mu), heavier(robot.platform2, mu)
    alike = replace(robot, platform1=one, platform2=two, physics=())
    assert motion(robot, state) == pytest.approx(motion(alike, state), rel=1e-9, abs=1e-11)
    assert energy(robot, state) == pytest.approx(energy(alike, state), rel=1e-10, abs=1e-14)
