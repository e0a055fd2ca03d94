"""Coulomb friction takes force times |u| at every wheel, once the wheel rolls."""

from dataclasses import replace

import pytest
from hypothesis import assume, given

from tests.mechanics.cases import REPEATABLE, cases, energy, wheel_speeds


@REPEATABLE
@given(cases(("coulomb_friction",)))
def test_power_at_the_wheels(case):
    robot, state = case
    speeds = wheel_speeds(robot, state)
    assume(min(abs(u) for u in speeds.values()) > 0.04)
    force = robot.physics[0].values
    power = sum(force[f"force{number}"] * abs(u) for (number, _), u in speeds.items())
    kinetic, dissipation = energy(robot, state)
    bare_kinetic, viscous = energy(replace(robot, physics=()), state)
    assert dissipation - viscous == pytest.approx(power, rel=1e-9, abs=1e-12)
    assert kinetic == pytest.approx(bare_kinetic, rel=1e-12)


@REPEATABLE
@given(cases())
def test_viscous_power_at_the_wheels(case):
    robot, state = case
    k = (robot.k1, robot.k2)
    power = sum(k[number - 1] * u**2 for (number, _), u in wheel_speeds(robot, state).items())
    assert energy(robot, state)[1] == pytest.approx(power, rel=1e-9, abs=1e-12)
