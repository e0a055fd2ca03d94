"""The mirror image of a motion is a motion: phi, yaw, torque and side forces change sign.

So it is of a robot in the mirror, where what is left is right; the model says of itself whether the
mirror image is a motion of the same robot.
"""

from dataclasses import replace

import pytest
from hypothesis import find, given

from rr_opt.model.robot import EffectUse, Robot
from rr_opt.motion.dynamics import derive, steady_effects
from tests.mechanics.cases import FIRST_FOUND, REPEATABLE, State, cases, energy, motion, sides

NAMES = sorted(steady_effects())
HANDED = {"left_right_drag", "com_offset", "axle_misalignment"}
"""Every parameter of these changes its sign in the mirror."""


def in_the_mirror(robot: Robot) -> Robot:
    uses = (
        EffectUse(
            use.name,
            {name: -value if use.name in HANDED else value for name, value in use.values.items()},
        )
        for use in robot.physics
    )
    return replace(robot, physics=tuple(uses))


@pytest.mark.parametrize("effects", [(), *((name,) for name in NAMES), tuple(NAMES)], ids="+".join)
def test_mirrored_state_moves_in_the_mirror(effects):
    @REPEATABLE
    @given(cases(effects))
    def mirrored(case):
        robot, (v, phi, dphi, ddphi) = case
        other, image = in_the_mirror(robot), State(v, -phi, -dphi, -ddphi)
        here, there = motion(*case), motion(other, image)
        expected = here.vdot, -here.w, -here.side, -here.torque
        assert there == pytest.approx(expected, rel=1e-10, abs=1e-11)
        F1, F2 = sides(*case)
        assert sides(other, image) == pytest.approx((-F1, -F2), rel=1e-10, abs=1e-11)
        assert energy(other, image) == pytest.approx(energy(*case), rel=1e-10, abs=1e-14)

    mirrored()


@pytest.mark.parametrize("name", NAMES)
def test_model_knows_whether_its_two_sides_are_alike(name):
    assert derive((name,)).mirrored == (name not in HANDED)
    if name in HANDED:

        def differs(case) -> bool:
            robot, (v, phi, dphi, ddphi) = case
            there = motion(robot, State(v, -phi, -dphi, -ddphi)).vdot
            return abs(there - motion(*case).vdot) > 1e-3

        find(cases((name,)), differs, settings=FIRST_FOUND)
