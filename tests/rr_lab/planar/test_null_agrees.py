"""With nothing hidden, the planar engine moves as MuJoCo and as the reduced model do."""

import sys

import numpy as np
import pytest

from rr_lab.case import play, record
from rr_lab.random_case import random_case
from rr_opt.model.gait import SineGait
from tests.rr_lab.planar.driven import channels, driven
from tests.rr_lab.reduced import LONG, SHORT, fitted

GAITS = (SineGait(0.6, 1.2), SineGait(0.5, 0.8, 0.25), SineGait(0.9, 0.9, 0.3))


def displacement(path):
    return np.linalg.norm(path[:2, -1] - path[:2, 0])


@pytest.mark.parametrize("robot", [LONG, SHORT], ids=["long", "short"])
@pytest.mark.parametrize("gait", GAITS, ids=str)
def test_path_and_displacement(robot, gait):
    seen = record(robot, gait, 6 * gait.period, "running", pose=(0.2, -0.1, 2.0), engine="planar")
    model = fitted(robot, gait, seen)
    path = np.array([seen.values[channel] for channel in ("x", "y", "psi")])
    assert displacement(path) == pytest.approx(displacement(model.path), rel=2e-5)
    # Of a sigma of 1 mm and 3 mrad.
    assert model.rms < 0.02


@pytest.mark.parametrize("robot", [LONG, SHORT], ids=["long", "short"])
def test_both_engines_end_alike(robot):
    gait = GAITS[1]
    one, other = (
        record(robot, gait, 6 * gait.period, "running", engine=engine)
        for engine in ("mujoco", "planar")
    )
    for channel, most in (("x", 2e-4), ("y", 2e-4), ("psi", 6e-4)):
        assert np.abs(one.values[channel] - other.values[channel]).max() < most


def test_start_from_rest():
    gait = SineGait(0.6, 1.2, 0.1)
    seen = record(SHORT, gait, 5 * gait.period, "rest", engine="planar")
    # The servo's rate jumps: the motor takes some milliseconds to reach it.
    assert fitted(SHORT, gait, seen, skip=10).rms < 0.01


@pytest.mark.parametrize("gait", GAITS, ids=str)
def test_the_motor_follows_its_command(gait):
    motion = driven(LONG, gait)
    assert np.abs(channels(motion)[3] - gait.angle(motion.t)).max() < 1e-4


def test_place_and_heading_do_not_matter():
    here = driven(LONG, GAITS[1]).one
    there = driven(LONG, GAITS[1], pose=(1.0, 2.0, 0.7)).one
    cos, sin = np.cos(0.7), np.sin(0.7)
    np.testing.assert_allclose(there[:, 0], 1 + cos * here[:, 0] - sin * here[:, 1], atol=1e-9)
    np.testing.assert_allclose(there[:, 1], 2 + sin * here[:, 0] + cos * here[:, 1], atol=1e-9)


def test_it_needs_no_mujoco(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    case = random_case(3, "single:floor_tilt", seconds=2.0, target=5.0, engine="planar")
    assert case.notes["visibility_floor_tilt"] == pytest.approx(5.0, rel=0.11)
    assert np.isfinite(play(case).runs[0].recording.values["x"]).all()
