"""Play whose joint is held by dry friction is the play operator; free of it, the joint swings."""

import numpy as np
import pytest

from rr_opt.effects import CATALOGUE
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait
from rr_opt.motion.floor_motion import free_joint
from tests.rr_lab.reduced import LONG

PLAY = CATALOGUE["servo_backlash"]
GAIT, WIDTH = SineGait(0.6, 1.0, 0.1), 0.08


def play_operator(u, width):
    """The output (n,) of classical play of this width, which begins in its middle."""
    y = [u[0]]
    for now in u[1:]:
        y.append(min(max(y[-1], now - width / 2), now + width / 2))
    return np.array(y)


def made(t, rest, friction):
    values = {"width": WIDTH, "joint_friction": friction}
    return PLAY.actuate(commanded(GAIT, rest), values, free_joint(LONG)).at(t)[0]


@pytest.mark.parametrize("rest", [True, False])
def test_with_much_friction_the_joint_stays_where_a_stop_leaves_it(rest):
    t = np.linspace(0.0, 5.0, 20001)
    drive = commanded(GAIT, rest)
    expected = play_operator(drive.at(t)[0], WIDTH)
    settled = t > 2 * GAIT.period
    off = made(t, rest, 5.0)[settled] - expected[settled]
    assert np.abs(off).max() < 1e-3
    assert np.ptp(expected[settled]) / 2 == pytest.approx(0.6 - WIDTH / 2, abs=1e-3)


def test_between_the_two_the_swing_shrinks_with_friction():
    t = np.linspace(5.0, 9.0, 8001)
    swings = [np.ptp(made(t, False, friction)) / 2 for friction in (0.0, 0.01, 0.05, 5.0)]
    assert swings[0] == pytest.approx(0.6 + WIDTH / 2, abs=2e-4)
    assert np.all(np.diff(swings) <= 1e-6)
