"""What looks wrong in a recording is said in a sentence; what looks right is not."""

from types import MappingProxyType

import numpy as np
import pytest

from rr_opt.model.experiment import CHANNELS, Flag, Recording
from rr_opt.model.gait import SineGait
from rr_opt.recordings.cleaning import clean
from rr_opt.recordings.inspection import Circumstances, inspect
from tests.recordings.clean.world import kinds, motion

NOISE = {"x": 1e-3, "y": 1e-3, "psi": 3e-3, "phi": 3e-3}


def recording(change=None, seed=0, moved=None, stated=True):
    """A plain recording; `change` spoils the values by channel, and t, in place."""
    moved, rng = moved or motion(), np.random.default_rng(seed)
    n = len(moved.t)
    values = {name: getattr(moved, name) + rng.normal(0, NOISE[name], n) for name in CHANNELS}
    values["t"] = moved.t.copy()
    if change:
        change(values)
    t = values.pop("t")
    flags = {name: np.where(np.isnan(values[name]), Flag.MISSING, 0).astype(np.uint8)
             for name in CHANNELS}  # fmt: skip
    sigma = {name: np.full(n, NOISE[name] if stated else np.nan) for name in CHANNELS}
    return Recording("run.csv", t, values, sigma, flags, MappingProxyType({}))


def texts(cleaned):
    return " ".join(doubt for doubt in cleaned.doubts)


def scaled(names, factor):
    def change(values):
        for name in names:
            values[name] = values[name] * factor

    return change


def test_a_good_recording_has_none():
    for seed in range(5):
        assert clean(recording(seed=seed)).doubts == ()


@pytest.mark.parametrize(
    ("names", "factor", "said"),
    [
        (("x", "y"), 1e3, "look like millimetres"),
        (("psi", "phi"), np.degrees(1), "look like degrees"),
        (("t",), 1e3, "look like milliseconds"),
        (("t",), 100.0, "frame numbers"),
        (("x",), 1e9, "in any unit"),
    ],
)
def test_another_unit_is_told_and_nothing_is_converted(names, factor, said):
    given = recording(scaled(names, factor))
    cleaned = clean(given)
    assert said in texts(cleaned)
    assert "units" in kinds(cleaned.doubts)
    for name in CHANNELS:
        np.testing.assert_array_equal(cleaned.recording.values[name], given.values[name])


def test_millimetres_are_told_with_the_ranges():
    def change(values):
        values["x"] = np.linspace(0, 1812, len(values["x"]))

    assert "1794" in texts(clean(recording(change)))  # 99 % of it


def test_whole_turns_are_taken_out():
    def change(values):
        values["psi"] = (values["psi"] + 3.0 + np.pi) % (2 * np.pi) - np.pi

    cleaned = clean(recording(change))
    assert kinds(cleaned.doubts) == {"turns"}
    apart = cleaned.recording.values["psi"] - motion().psi - 3.0
    assert np.abs(apart).max() < 0.02


def test_outliers_are_flagged_and_their_values_stay():
    def change(values):
        values["x"][[100, 2000]] += 0.05

    given = recording(change)
    cleaned = clean(given)
    flags = cleaned.recording.flags["x"]
    assert np.flatnonzero(flags & Flag.OUTLIER).tolist() == [100, 2000]
    np.testing.assert_array_equal(cleaned.recording.values["x"], given.values["x"])
    assert "x has 2 outliers" in texts(cleaned)
    assert "t = 1, 20 s" in texts(cleaned)


def test_gaps_are_told_and_not_filled():
    def change(values):
        for name in CHANNELS:
            values[name][1000:1030] = np.nan
        values["y"][500:503] = np.nan

    cleaned = clean(recording(change))
    assert [(gap.channels, gap.samples) for gap in cleaned.gaps] == [(("y",), 3), (CHANNELS, 30)]
    assert np.isnan(cleaned.recording.data("x")[1000:1030]).all()
    assert "no data for 0.31 s after t = 9.99 s" in texts(cleaned)
    assert "1 short gap" in texts(cleaned)


def test_a_noise_that_is_not_the_stated_one_is_told():
    rng = np.random.default_rng(5)

    def change(values):
        values["y"] += rng.normal(0, 2e-3, len(values["y"]))

    told = texts(clean(recording(change)))
    assert "The noise of y is 2." in told
    assert "1 mm was stated" in told


def test_a_noise_that_nobody_states_is_estimated():
    cleaned = clean(recording(stated=False))
    assert cleaned.doubts == ()
    for name in CHANNELS:
        assert np.abs(cleaned.recording.sigma[name] / NOISE[name] - 1).max() < 0.1


def test_a_jump_is_told():
    def change(values):
        values["x"][1500:] += 0.04

    cleaned = clean(recording(change))
    assert kinds(cleaned.doubts) == {"jump"}
    assert "s: x by 4" in texts(cleaned)
    assert "t = 14.99 s" in texts(cleaned)


def test_a_robot_that_hardly_moves_is_told():
    still = motion(10.0, SineGait(0.06, 1.0, 0.0))
    assert "hardly moves" in " ".join(inspect(recording(moved=still), None, Circumstances()).doubts)


def test_a_servo_that_does_not_move_is_told():
    still = motion(10.0, SineGait(0.0, 1.0, 0.1))
    told = inspect(recording(moved=still), None, Circumstances()).doubts
    assert "phi does not move" in " ".join(told)
