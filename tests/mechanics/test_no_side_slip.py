"""The yaw rate and side speed of the model let neither axle slip, and equal equation (4)."""

from math import cos, sin

import numpy as np
from hypothesis import given

from tests.mechanics import multipliers
from tests.mechanics.cases import REPEATABLE, cases, motion, numbers


@REPEATABLE
@given(cases(), numbers(-3.0, 3.0))
def test_both_axles_hold(case, psi):
    robot, state = case
    out = motion(robot, state)
    xdot = state.v * cos(psi) - out.side * sin(psi)
    ydot = state.v * sin(psi) + out.side * cos(psi)
    q = np.array([0.0, 0.0, psi, state.phi])
    qd = np.array([xdot, ydot, out.w, state.dphi])
    np.testing.assert_allclose(multipliers.slip(robot, q, qd), 0.0, atol=1e-12)


@REPEATABLE
@given(cases())
def test_speeds_are_the_papers(case):
    robot, (v, phi, dphi, _) = case
    c1, c2 = robot.platform1.c, robot.platform2.c
    out = motion(*case)
    w = -(v * sin(phi) + c2 * dphi) / (c1 * cos(phi) + c2)
    np.testing.assert_allclose([out.w, out.side], [w, -c1 * w], rtol=1e-10, atol=1e-12)
