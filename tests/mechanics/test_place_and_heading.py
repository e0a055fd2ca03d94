"""Wherever the robot stands and heads, speed, torque and side forces are the same.

The model with multipliers has x, y and psi in it; the derived one has not.
"""

import math

import numpy as np
import pytest
from hypothesis import given

from rr_opt.model.robot import Robot
from tests.mechanics import multipliers
from tests.mechanics.cases import REPEATABLE, State, cases, motion, numbers, sides


def at_place(robot: Robot, state: State, x: float, y: float, psi: float, beyond=multipliers.PAPER):
    """(vdot, w, torque, F1, F2) of the model with multipliers."""
    q = np.array([x, y, psi, state.phi])
    qd = multipliers.rates(robot, q, state.v, state.dphi)
    qdd, (F1, F2, torque) = multipliers.solve(robot, q, qd, state.ddphi, beyond)
    return multipliers.forward_acceleration(q, qd, qdd), qd[2], torque, F1, F2


def derived(robot: Robot, state: State):
    out = motion(robot, state)
    return out.vdot, out.w, out.torque, *sides(robot, state)


places = (numbers(-10.0, 10.0), numbers(-10.0, 10.0), numbers(-7.0, 7.0))


@REPEATABLE
@given(cases(), *places)
def test_paper_model(case, x, y, psi):
    assert at_place(*case, x, y, psi) == pytest.approx(derived(*case), rel=1e-8, abs=1e-9)


@REPEATABLE
@given(cases(("coulomb_friction", "quadratic_drag")), *places)
def test_with_friction_of_the_catalogue(case, x, y, psi):
    robot, _ = case
    coulomb, quadratic = (use.values for use in robot.physics)

    def law(wheel: multipliers.Wheel, u: float) -> float:
        number = wheel.number
        dry = coulomb[f"force{number}"] * math.tanh(u / 0.002)
        drag = quadratic["coefficient_total"] / 4 * abs(u) * u
        return -(robot.k1, robot.k2)[number - 1] * u - dry - drag

    # |u| is smoothed below 0.1 mm/s in the catalogue and is not here, hence the looser bounds.
    bodies = quadratic["coefficient_bodies"]
    found = at_place(*case, x, y, psi, multipliers.Beyond(law, bodies=bodies))
    assert found == pytest.approx(derived(*case), rel=1e-5, abs=1e-5)


@REPEATABLE
@given(cases(("wheel_inertia",)), *places)
def test_with_turning_wheels(case, x, y, psi):
    J = case[0].physics[0].values["J"]
    assert at_place(*case, x, y, psi, multipliers.Beyond(J=J)) == pytest.approx(
        derived(*case), rel=1e-8, abs=1e-9
    )
