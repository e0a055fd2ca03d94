"""Steps taken all at once are those taken one by one, and to be watched does not move the robot."""

import numpy as np
import pytest

from rr_lab.effects import rig_with
from rr_lab.mujoco import drive
from rr_lab.mujoco.plant import Plant, stepped
from rr_lab.run import Conditions
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from rr_opt.outcome import NotConvergedError
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.8, 1.0, 0.2)
USES = (
    EffectUse("floor_tilt", {"tilt_x": 5e-3, "tilt_y": -3e-3}),
    EffectUse("coulomb_friction", {"force1": 2e-3, "force2": 1e-3}),
    EffectUse("servo_backlash", {"width": 0.03}),
    EffectUse("clock_offset", {"offset": -0.2}),
)


def driven(uses, *, law=None, step=1e-3, **how):
    rig = rig_with(LONG, uses)
    if law:
        rig.laws.append(law)
    return drive(rig, GAIT, Conditions(2.0, **how), step)


def assert_same(one, other):
    for name in ("t", "one", "two"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


@pytest.mark.parametrize("start", ["rest", "running"])
@pytest.mark.parametrize("uses", [(), *((use,) for use in USES), USES])
def test_all_at_once_or_one_by_one(start, uses):
    """A law, even one that does nothing, has each step taken by itself."""
    asked = []
    one_by_one = driven(uses, start=start, law=lambda wheels: asked.append(wheels.t))
    np.testing.assert_allclose(np.diff(asked), 1e-3)
    assert_same(driven(uses, start=start), one_by_one)


def test_to_write_down_the_torque_moves_nothing():
    plain, told = driven(USES), driven(USES, torque=True)
    assert_same(plain, told)
    assert plain.torque is None
    assert told.torque.shape == told.t.shape


def test_a_push_comes_once_and_at_the_recordings_beginning():
    plain, pushed = (driven((), start="running", nudge=nudge) for nudge in (0.0, 0.02))
    np.testing.assert_array_equal(pushed.one[0], plain.one[0])
    ahead = np.array([np.cos(plain.one[0, 2]), np.sin(plain.one[0, 2])])
    gained = (pushed.one[1] - plain.one[1])[:2] @ ahead / (plain.t[1] - plain.t[0])
    # The axles do not let it all through: no more than what the whole mass would gain.
    assert 0.002 < gained < 0.021


def test_sensors_see_the_beginning_of_each_step():
    plant = Plant.of(rig_with(LONG), 1e-3)
    plant.put_down((0.3, -0.2, 0.5), 0.4)
    first = stepped(plant, np.zeros(3), np.zeros(3))[0]
    np.testing.assert_allclose(first[[0, 1, 6, 7]], [0.3, -0.2, 0.3, -0.2], atol=1e-12)
    np.testing.assert_allclose(first[3:5], [np.cos(0.5), np.sin(0.5)], atol=1e-12)
    np.testing.assert_allclose(first[9:11], [np.cos(0.9), np.sin(0.9)], atol=1e-12)


def test_no_part_of_a_step_is_timed():
    plant = Plant.of(rig_with(LONG), 1e-3)
    stepped(plant, np.zeros(10), np.zeros(10))
    assert not plant.data.timer.duration.any()


@pytest.mark.parametrize("law", [None, lambda wheels: None], ids=["all at once", "one by one"])
@pytest.mark.parametrize("start", ["rest", "running"])
def test_a_motion_lost_before_the_recording_is_told(start, law):
    """What is lost while the robot settles is not seen any more where it is driven on."""
    rig = rig_with(LONG)
    rig.shapers.append(lambda t, angle: np.where(np.arange(len(t)) == 10, 1e9, angle))
    if law:
        rig.laws.append(law)
    with pytest.raises(NotConvergedError, match="diverged"):
        drive(rig, GAIT, Conditions(0.2, start), 1e-3)
