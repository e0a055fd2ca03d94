"""The mirror image of a motion is a motion: phi, yaw, torque and side forces change sign."""

import pytest
from hypothesis import given

from rr_opt.physics.effects import CATALOGUE
from tests.physics.cases import REPEATABLE, State, cases, energy, motion, sides


@pytest.mark.parametrize(
    "effects", [(), *((name,) for name in CATALOGUE), tuple(CATALOGUE)], ids="+".join
)
def test_mirrored_state_moves_in_the_mirror(effects):
    @REPEATABLE
    @given(cases(effects))
    def mirrored(case):
        robot, (v, phi, dphi, ddphi) = case
        image = State(v, -phi, -dphi, -ddphi)
        here, there = motion(*case), motion(robot, image)
        expected = here.vdot, -here.w, -here.side, -here.torque
        assert there == pytest.approx(expected, rel=1e-10, abs=1e-12)
        F1, F2 = sides(*case)
        assert sides(robot, image) == pytest.approx((-F1, -F2), rel=1e-10, abs=1e-12)
        assert energy(robot, image) == pytest.approx(energy(*case), rel=1e-10, abs=1e-14)

    mirrored()
