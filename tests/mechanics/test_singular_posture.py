"""As phi nears arccos(-c2/c1) yaw rate and acceleration grow without bound, as 1/S1."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.mechanics.cases import REPEATABLE, State, motion, numbers, robots


@REPEATABLE
@given(robots(), st.sampled_from([1, -1]), numbers(0.1, 0.5), numbers(1.0, 5.0))
def test_ten_times_closer_is_ten_times_faster(robot, side, v, dphi):
    # side*dphi > 0 and v > 0: both parts of w = -(v sin phi + c2 dphi)/S1 have one sign.
    gaps = np.array([1e-4, 1e-5, 1e-6])
    near = [
        motion(robot, State(v, side * (robot.singular_angle - gap), side * dphi, 0.0))
        for gap in gaps
    ]
    w = np.array([out.w for out in near])
    vdot = np.array([out.vdot for out in near])
    assert np.all(np.abs(w) * gaps > 0.01)
    np.testing.assert_allclose(w[1:] / w[:-1], 10.0, rtol=1e-2)
    np.testing.assert_allclose(vdot[1:] / vdot[:-1], 10.0, rtol=3e-2)
    # What is left of equation (3) there: axle 1 is dragged along as P swings round it.
    np.testing.assert_allclose(vdot[-1], robot.platform1.c * side * dphi * w[-1], rtol=1e-2)


@REPEATABLE
@given(robots())
def test_singular_angle_is_the_first_root_of_S1(robot):
    c1, c2 = robot.platform1.c, robot.platform2.c
    assert c1 * math.cos(robot.singular_angle) + c2 == pytest.approx(0.0, abs=1e-15)
    assert 0 < robot.singular_angle <= math.pi
    swapped = replace(robot, platform1=robot.platform2, platform2=robot.platform1)
    assert swapped.singular_angle == math.inf
    twins = replace(robot, platform2=robot.platform1)
    assert twins.singular_angle == pytest.approx(math.pi)
