"""The folder of a case is what the readers read: the same motion, in every format."""

from dataclasses import replace

import numpy as np
import pytest

from rr_lab.case import play, recorded
from rr_lab.files import Delivery, folder_of
from rr_lab.formats import ServoClock
from rr_lab.random_case import random_case
from rr_opt.model.experiment import Noise
from rr_opt.model.robot import EffectUse
from rr_opt.recordings.experiment import read_experiment
from rr_opt.recordings.readers import read_file


@pytest.fixture(scope="module")
def case():
    drawn = random_case(3, "null", seconds=2.0)
    return replace(drawn, plans=drawn.plans[:1], noise=Noise(1e-4, 1e-4), missing=0.02)


def written(case, folder, delivery):
    for name, content in folder_of(case, delivery):
        (folder / name).write_bytes(content)
    return read_experiment(folder)


def test_plain_csv_comes_back_as_it_was(case, tmp_path):
    read, made = written(case, tmp_path, Delivery(torque=True)), play(case)
    assert read.robot.platform1 == case.nominal.platform1
    assert read.noise.position == case.noise.position
    for one, other in zip(read.runs, made.runs, strict=True):
        assert (one.use, one.start) == (other.use, other.start)
        assert one.gait.angle(0.3) == pytest.approx(other.gait.angle(0.3))
        assert "torque" in one.recording.channels
        for channel in ("x", "y", "psi", "phi"):
            np.testing.assert_allclose(
                one.recording.data(channel), other.recording.values[channel], atol=1e-6
            )
    for name, known in case.uncertainty.items():
        assert read.uncertainty[name].sigma == pytest.approx(known.sigma)
        assert read.uncertainty[name].factor == known.factor


@pytest.mark.parametrize("form", ["vicon", "c3d"])
def test_markers_give_the_motion(case, tmp_path, form):
    read, made = written(case, tmp_path, Delivery(form)), play(replace(case, missing=0.0))
    for one, other in zip(read.runs, made.runs, strict=True):
        for channel, most in (("x", 6e-4), ("y", 6e-4), ("psi", 0.02), ("phi", 0.02)):
            seen, true = one.recording.data(channel), other.recording.values[channel]
            good = np.isfinite(seen)
            assert good.mean() > 0.8
            turns = 2 * np.pi * np.round((seen - true)[good][0] / (2 * np.pi))
            assert np.abs(seen - true - turns * (channel == "psi"))[good].max() < most


def test_servo_log_has_its_own_clock(case, tmp_path):
    clock = ServoClock(offset=0.2, drift=1e-4)
    written(case, tmp_path, Delivery(servo_log=True, clock=clock))
    log = read_file(tmp_path / "run01-servo.csv")
    assert log.rate == pytest.approx(250)
    gait, begin = case.plans[0].gait, case.plans[0].conditions.begin(case.plans[0].gait)
    command = np.maximum(log.t / (1 + clock.drift) + clock.offset, begin)
    # Half a count of 5.1 mrad.
    np.testing.assert_allclose(log.goal_angle, gait.angle(command), atol=2.6e-3)


@pytest.mark.parametrize(("name", "values"), [("first_order", {}), ("p_loop", {"zeta": 0.8})])
def test_servo_log_shows_the_lag(case, tmp_path, name, values):
    lag = EffectUse(f"servo_lag/{name}", {"tau": 0.06, **values})
    lagging = replace(case, effects=(lag,), engine="planar")
    written(lagging, tmp_path, Delivery(servo_log=True))
    log, seen = read_file(tmp_path / "run01-servo.csv"), recorded(replace(lagging, missing=0.0), 0)
    present = np.interp(seen.t, log.t, log.present_angle)
    np.testing.assert_allclose(present, seen.values["phi"], atol=3.5e-3)
    assert np.abs(log.present_angle - log.goal_angle).max() > 0.05
