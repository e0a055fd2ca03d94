"""A robot whose centres of mass lie to the left has the energy of masses that move there."""

from math import cos, sin

import numpy as np
import pytest
from hypothesis import given

from tests.mechanics.cases import REPEATABLE, cases, energy, motion


@REPEATABLE
@given(cases(("com_offset",)))
def test_kinetic_energy(case):
    robot, state = case
    out, values = motion(robot, state), robot.physics[0].values
    joint = np.array([state.v, out.side])
    total = 0.0
    for part, angle, rate, ahead, left in (
        (robot.platform1, 0.0, out.w, 1.0, values["d1"]),
        (robot.platform2, state.phi, out.w + state.dphi, -1.0, values["d2"]),
    ):
        reach = ahead * part.joint_to_centre
        x = reach * cos(angle) - left * sin(angle)
        y = reach * sin(angle) + left * cos(angle)
        V = joint + rate * np.array([-y, x])
        total += part.m * V @ V / 2 + part.I * rate**2 / 2
    assert energy(robot, state)[0] == pytest.approx(total, rel=1e-10)
