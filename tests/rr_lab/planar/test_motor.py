"""The motor's torque is MuJoCo's, and what has play moves as far as the play lets it."""

import numpy as np
import pytest

from rr_lab.case import record
from rr_opt.model.gait import SineGait
from tests.rr_lab.planar.driven import channels, driven
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.6, 1.0, 0.1)


def test_torque():
    one, other = (
        record(LONG, GAIT, 2.0, "running", torque=True, engine=engine).values["torque"]
        for engine in ("mujoco", "planar")
    )
    assert np.abs(one - other).max() < 0.01 * np.abs(one).max()


@pytest.mark.parametrize("width", [0.04, 4e-3])
def test_play(width):
    motion = driven(LONG, GAIT, 2.0, "running", ("servo_backlash", {"width": width}))
    phi = channels(motion)[3]
    assert np.abs(phi - GAIT.angle(motion.t)).max() == pytest.approx(width / 2, rel=0.05)
    # Driven by inertia the platform runs ahead: the amplitude grows by half the play.
    assert np.ptp(phi) / 2 == pytest.approx(0.6 + width / 2, rel=2e-3)


def test_a_loose_pin_stays_in_its_hole():
    clearance = 2e-3
    motion = driven(LONG, GAIT, 2.0, "running", ("loose_pin", {"clearance": clearance}))
    apart = np.hypot(*(motion.two - motion.one)[:, :2].T)
    assert apart.max() == pytest.approx(clearance, rel=0.05)
    assert np.median(apart) > 0.2 * clearance
