"""Quadratic drag of wheels takes c |u|^3 in total, a quarter of c at each of the four wheels."""

from dataclasses import replace

import pytest
from hypothesis import assume, given

from tests.mechanics.cases import REPEATABLE, cases, energy, wheel_speeds


def at_wheels_alone(robot):
    (use,) = robot.physics
    return replace(robot, physics=(replace(use, values={**use.values, "coefficient_bodies": 0.0}),))


@REPEATABLE
@given(cases(("quadratic_drag",)))
def test_power_at_the_wheels(case):
    robot, state = at_wheels_alone(case[0]), case[1]
    speeds = wheel_speeds(robot, state).values()
    assume(min(abs(u) for u in speeds) > 0.02)
    c = robot.physics[0].values["coefficient_total"]
    power = sum(c / 4 * abs(u) ** 3 for u in speeds)
    _, dissipation = energy(robot, state)
    _, viscous = energy(replace(robot, physics=()), state)
    assert dissipation - viscous == pytest.approx(power, rel=1e-4, abs=1e-12)
