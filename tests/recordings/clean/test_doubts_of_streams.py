"""What a capture does to a whole stream is told as one thing, and no good sample is flagged."""

import numpy as np
import pytest
from scipy.signal import butter, filtfilt

from rr_opt.model.experiment import CHANNELS, Layout, Recording
from rr_opt.outcome import InputError
from rr_opt.recordings.cleaning import clean
from rr_opt.recordings.markers.pose import fit_markers
from tests.recordings.clean.world import LAYOUT, kinds, markers, motion

SIZES = {"x": 1e-3, "y": 1e-3, "psi": 3e-3, "phi": 3e-3}


def noisy(change=lambda y: y, stated=True, seed=0, t=None):
    moved, rng = motion(), np.random.default_rng(seed)
    values = {
        name: change(getattr(moved, name) + rng.normal(0, size, len(moved.t)))
        for name, size in SIZES.items()
    }
    sigma = {name: np.full(len(moved.t), size if stated else np.nan)
             for name, size in SIZES.items()}  # fmt: skip
    flags = {name: np.zeros(len(moved.t), np.uint8) for name in CHANNELS}
    return Recording("run.csv", moved.t if t is None else t, values, sigma, flags)


@pytest.mark.parametrize("stated", [True, False])
@pytest.mark.parametrize("cut", [0.1, 0.2, 0.5])
def test_a_filtered_recording_has_no_outliers(cut, stated):
    made = clean(noisy(lambda y: filtfilt(*butter(2, cut), y), stated))
    assert {
        name: int((made.recording.flags[name] > 0).sum()) for name in CHANNELS
    } == dict.fromkeys(CHANNELS, 0)
    assert "colour" in kinds(made.doubts)
    assert "jump" not in kinds(made.doubts)


def test_rounding_is_told_and_is_no_jump():
    made = clean(noisy(lambda y: np.round(y, 2)))
    told = [doubt for doubt in made.doubts if doubt.kind == "steps"]
    assert [text.split()[0] for text in told] == list(CHANNELS)
    assert "steps of 10 mm" in told[0]
    assert "jump" not in kinds(made.doubts)
    assert not any(doubt.kind == "steps" for doubt in clean(noisy(lambda y: y.round(6))).doubts)


def test_a_stream_that_stood_still_is_flagged():
    def hang(y):
        y[500:520] = y[499]
        return y

    made = clean(noisy(hang))
    assert all((made.recording.flags[name][500:520] == 2).all() for name in CHANNELS)
    assert "frozen stream" in " ".join(doubt for doubt in made.doubts)
    assert "jump" not in kinds(made.doubts)
    assert "held" not in kinds(clean(noisy()).doubts)


@pytest.mark.parametrize("cut", [None, 0.1, 0.2])
def test_gaps_filled_by_a_curve_are_flagged(cut):
    def fill(y):
        y = y if cut is None else filtfilt(*butter(2, cut), y)
        gap, near = np.arange(500, 525), np.r_[485:500, 525:540]
        y[gap] = np.polynomial.Polynomial.fit(near, y[near], 3)(gap)
        return y

    made = clean(noisy(fill))
    for name in CHANNELS:
        rows = np.flatnonzero(made.recording.flags[name])
        assert set(range(500, 525)) <= set(rows.tolist()) <= set(range(496, 529))
    assert "filled" in kinds(made.doubts)
    assert "filled" not in kinds(clean(noisy()).doubts)


def test_a_floor_frame_set_anew_is_one_doubt():
    recording = noisy()
    turn = np.exp(0.3j)
    place = (recording.values["x"] + 1j * recording.values["y"])[1000:] * turn + 0.1
    recording.values["x"][1000:], recording.values["y"][1000:] = place.real, place.imag
    recording.values["psi"][1000:] += 0.3
    told = [doubt for doubt in clean(recording).doubts if doubt.kind == "jump"]
    assert len(told) == 1
    assert "at t = 9.99 s" in told[0]
    assert "floor frame" in told[0]


def test_all_channels_at_once_are_time_that_is_missing():
    def cut(y):
        return np.concatenate([y[:700], y[740:], y[-40:]])

    text = next(doubt for doubt in clean(noisy(cut)).doubts if doubt.kind == "jump")
    assert "Missing time" in text


def test_rows_that_are_known_to_be_lacking_are_no_jump():
    keep = np.r_[0:700, 740:3001]
    whole = noisy()
    short = Recording("run.csv", whole.t[keep], *(
        {name: one[keep] for name, one in part.items()}
        for part in (whole.values, whole.sigma, whole.flags)))  # fmt: skip
    assert "jump" not in kinds(clean(short).doubts)


@pytest.mark.parametrize(("factor", "said"), [(1e3, "like millimetres"), (1e-3, "like metres")])
def test_markers_in_another_unit_than_the_layout(factor, said):
    data = markers(motion(), 5e-4, 1)
    layout = Layout(*(
        {name: tuple(size / factor for size in place) for name, place in one.items()}
        for one in (LAYOUT.platform1, LAYOUT.platform2)))  # fmt: skip
    with pytest.raises(InputError, match=said):
        fit_markers(data, layout)
