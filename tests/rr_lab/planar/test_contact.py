"""Wheels creep and slide sideways as much as they are told to, and share their grip."""

import numpy as np
import pytest

from rr_lab.rig import wheel_loads
from rr_opt.model.gait import SineGait
from tests.rr_lab.planar.driven import driven, rig
from tests.rr_lab.reduced import LONG

STILL = SineGait(0.0, 1.0)
SLOPE = 0.05
G = 9.81


def side_speeds(made):
    """Of each wheel of a straight, locked robot on its slope, m/s to the left, after a while."""
    motion = driven(made, STILL, 0.3, "rest")
    vy = np.diff(motion.one[-2:, 1])[0] * 100
    turn = np.diff(motion.one[-2:, 2])[0] * 100
    one, two = LONG.platform1, LONG.platform2
    return [vy + turn * x for x in (one.c, one.c, -two.c, -two.c)]


def test_creep_is_speed_over_force():
    made = rig(LONG, ("lateral_slip", {"creep_compliance": 0.1}), ("floor_tilt", {"tilt_y": SLOPE}))
    push = G * np.sin(SLOPE) * (LONG.platform1.m + LONG.platform2.m)
    # Four wheels share the push; the masses do not sit over the middle, so it turns a little too.
    total = sum(side_speeds(made)) / 0.1
    assert total == pytest.approx(push, rel=2e-3)


@pytest.mark.parametrize(("share", "slides"), [(0.97, False), (1.03, True)])
def test_slides_beyond_the_grip(share, slides):
    made = rig(LONG, ("lateral_slip", {"mu": 0.1}))
    made.tilt = (0.0, np.arctan(0.1 * share))
    assert (min(side_speeds(made)) > 5e-3) == slides


def test_a_sliding_wheel_shares_its_grip():
    """On a slope across and along with brakes that hold more than the grip, it slides straight down
    the slope, as a block does."""
    made = rig(LONG, ("lateral_slip", {"mu": 0.1}))
    made.dry = [1.0] * 4
    made.tilt = (0.1, 0.1)
    path = driven(made, STILL, 0.5, "rest").one
    vx, vy = np.diff(path[-2:, :2], axis=0)[0] * 100
    assert vx == pytest.approx(vy, rel=0.02)
    slope = np.hypot(*made.gravity[:2])
    expected = (slope - 0.1 * -made.gravity[2]) * 0.495
    assert np.hypot(vx, vy) == pytest.approx(expected, rel=0.02)


def test_wheels_carry_the_weight_without_tipping():
    made = rig(LONG, ("com_offset", {"d1": 0.01, "d2": -0.02}))
    carried = wheel_loads(made)
    one, two = LONG.platform1, LONG.platform2
    places = np.array([(one.c, one.b), (one.c, -one.b), (-two.c, two.b), (-two.c, -two.b)])
    masses = [(one.m, one.joint_to_centre, 0.01), (two.m, -two.joint_to_centre, -0.02)]
    assert carried.sum() == pytest.approx(G * (one.m + two.m))
    moment = sum(m * G * np.array([x, y]) for m, x, y in masses)
    np.testing.assert_allclose(carried @ places, moment)
    even = wheel_loads(rig(LONG))
    on1 = G * (one.m * (one.c + two.c - one.a) + two.m * two.a) / (one.c + two.c)
    np.testing.assert_allclose(even[:2], on1 / 2)
