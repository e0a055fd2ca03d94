"""An axle that is turned rolls off at its angle: both turned alike make the straight robot crab.

Whatever its posture, neither axle's centre moves across its own turned rolling direction.
"""

from dataclasses import replace
from math import cos, sin, tan

import numpy as np
import pytest
from hypothesis import given

from rr_opt.model.robot import EffectUse
from tests.mechanics.cases import REPEATABLE, State, cases, motion, numbers, robots


@REPEATABLE
@given(robots(), numbers(-0.2, 0.2), numbers(-0.5, 0.5))
def test_crab(robot, toe, v):
    use = EffectUse("axle_misalignment", {"toe1": toe, "toe2": toe})
    out = motion(replace(robot, physics=(use,)), State(v, 0.0, 0.0, 0.0))
    assert (out.w, out.side) == pytest.approx((0.0, v * tan(toe)), abs=1e-12)


@REPEATABLE
@given(cases(("axle_misalignment",)))
def test_no_side_slip_of_turned_axles(case):
    robot, state = case
    out, toe = motion(robot, state), robot.physics[0].values
    joint = np.array([state.v, out.side])
    for angle, rate, reach, turn in (
        (0.0, out.w, robot.platform1.c, toe["toe1"]),
        (state.phi, out.w + state.dphi, -robot.platform2.c, toe["toe2"]),
    ):
        V = joint + rate * reach * np.array([-sin(angle), cos(angle)])
        across = np.array([-sin(angle + turn), cos(angle + turn)])
        assert across @ V == pytest.approx(0.0, abs=1e-11)
