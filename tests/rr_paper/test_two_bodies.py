"""Two separate bodies with multipliers have the accelerations, torque and path of Kane's method."""

import numpy as np
import pytest
from hypothesis import given

from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import rollout
from rr_paper import two_bodies
from rr_paper.two_bodies import path
from tests.mechanics.cases import REPEATABLE, cases, energy, motion
from tests.robots import BENCHMARK


@REPEATABLE
@given(cases())
def test_acceleration_and_torque(case):
    robot, (v, phi, dphi, ddphi) = case
    q, qd = two_bodies.placed(robot, phi, dphi, v)
    found = two_bodies.accelerate(robot, q, qd, ddphi)
    expected = motion(robot, case[1])
    vdot = two_bodies.forward_acceleration(q, qd, found.acceleration)
    assert vdot == pytest.approx(expected.vdot, rel=1e-9, abs=1e-9)
    assert found.torque == pytest.approx(expected.torque, rel=1e-9, abs=1e-9)
    assert qd[2] == pytest.approx(expected.w, rel=1e-9, abs=1e-12)


@REPEATABLE
@given(cases())
def test_friction_is_the_dissipation(case):
    robot, (v, phi, dphi, _) = case
    q, qd = two_bodies.placed(robot, phi, dphi, v)
    taken = -two_bodies.friction(robot, q, qd) @ qd
    assert taken == pytest.approx(energy(robot, case[1])[1], rel=1e-9, abs=1e-15)


def test_the_path_is_that_of_cvodes():
    gait = SineGait(0.6, 1.0, 0.15)
    expected = rollout(BENCHMARK, gait, 3.0, "rest", 10.0)
    found = path(BENCHMARK, gait, expected.t)
    for name in ("x", "y", "psi", "v"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), atol=1e-7)
    assert found.drift < 1e-8
