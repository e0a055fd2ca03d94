"""With nothing hidden, the laboratory moves as the reduced model does."""

import numpy as np
import pytest

from rr_lab.case import record
from rr_opt.model.gait import SineGait
from tests.rr_lab.reduced import LONG, SHORT, fitted

GAITS = (SineGait(0.6, 1.2), SineGait(0.5, 0.8, 0.25))


@pytest.mark.parametrize("robot", [LONG, SHORT], ids=["long", "short"])
@pytest.mark.parametrize("gait", GAITS, ids=str)
def test_path_and_displacement(robot, gait):
    periods = 6
    seen = record(robot, gait, periods * gait.period, "running", pose=(0.2, -0.1, 2.0))
    model = fitted(robot, gait, seen)
    ends = np.array([seen.values["x"], seen.values["y"]])
    moved = np.linalg.norm(ends[:, -1] - ends[:, 0])
    expected = np.linalg.norm(model.path[:2, -1] - model.path[:2, 0])
    assert moved == pytest.approx(expected, rel=1e-3)
    # Of a sigma of 1 mm and 3 mrad: far below what noise lets see.
    assert model.rms < 0.002


@pytest.mark.parametrize("start", ["rest", "running"])
def test_angle_is_the_command(start):
    gait = SineGait(0.9, 1.0, 0.2)
    seen = record(LONG, gait, 3.0, start)
    np.testing.assert_allclose(seen.values["phi"], gait.angle(seen.t), atol=1e-6)


def test_start_from_rest():
    gait = SineGait(0.6, 1.2, 0.1)
    seen = record(SHORT, gait, 5 * gait.period, "rest")
    # The first 0.1 s: the jump of the servo's rate is one blow in one step, and the speed that it
    # leaves is fitted.
    assert fitted(SHORT, gait, seen, skip=10).rms < 0.002


def test_place_and_heading_do_not_matter():
    gait = SineGait(0.6, 1.2, 0.2)
    here = record(LONG, gait, 3.0, "running")
    there = record(LONG, gait, 3.0, "running", pose=(1.0, 2.0, 0.7))
    cos, sin = np.cos(0.7), np.sin(0.7)
    x, y = here.values["x"], here.values["y"]
    np.testing.assert_allclose(there.values["x"], 1 + cos * x - sin * y, atol=1e-7)
    np.testing.assert_allclose(there.values["y"], 2 + sin * x + cos * y, atol=1e-7)
