"""Whatever numbers a file holds, they become a recording or a clear error."""

from types import MappingProxyType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rr_opt.documents.archive import strict_json
from rr_opt.model.experiment import CHANNELS, Flag, Recording
from rr_opt.model.gait import SineGait
from rr_opt.outcome import InputError
from rr_opt.recordings.inspection import Circumstances, inspect
from rr_opt.recordings.markers.pose import fit_markers
from rr_opt.recordings.readers.marker_rows import MarkerData
from rr_opt.results.inspection import InspectedRecordings
from tests.recordings.clean.world import LAYOUT

SHAPES = ("wiggle", "constant", "zero", "steps", "noise", "nan", "one value", "alternating", "huge")


def channel(shape, n, size, rng):
    """n samples of a shape, of a size."""
    if shape == "wiggle":
        return size * np.sin(0.06 * np.arange(n)) + 1e-3 * size * rng.normal(size=n)
    if shape == "noise":
        return size * rng.normal(size=n)
    if shape == "steps":
        return size * np.floor(np.arange(n) / 7)
    if shape == "alternating":
        return size * (-1.0) ** np.arange(n)
    if shape == "huge":
        return rng.choice([1e9, -1e9, 1e300, 1e-300, 0.0], n)
    filled = {"constant": size, "zero": 0.0}.get(shape, np.nan)
    y = np.full(n, filled)
    if shape == "one value":
        y[n // 2] = size
    return y


@st.composite
def recordings(draw):
    n = draw(st.sampled_from([2, 3, 5, 8, 14, 40, 300]))
    rng = np.random.default_rng(draw(st.integers(0, 2**20)))
    size = draw(st.sampled_from([1e-12, 1e-3, 1.0, 1e3, 1e9]))
    values = {name: channel(draw(st.sampled_from(SHAPES)), n, size, rng) for name in CHANNELS}
    holes = rng.random(n) < draw(st.sampled_from([0.0, 0.2, 0.9]))
    flags = {}
    for name in CHANNELS:
        values[name][holes] = np.nan
        flags[name] = np.where(np.isnan(values[name]), Flag.MISSING, 0).astype(np.uint8)
    least, jitter = draw(st.sampled_from([(0.5, 1), (1e-12, 1), (1e-12, 9)]))
    t = np.cumsum(least + rng.random(n) ** jitter) * draw(st.sampled_from([1e-6, 1e-2, 1.0, 1e4]))
    if draw(st.booleans()):
        t[n // 2 :] += draw(st.sampled_from([1e-9, 10.0, 1e6]))
    sigma = np.full(n, draw(st.sampled_from([1e-9, 1e-3, np.nan, 10.0])))
    return Recording("run.csv", t, values, dict.fromkeys(CHANNELS, sigma), flags)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(recordings())
def test_any_recording_is_inspected(given_recording):
    found = inspect(given_recording, None, Circumstances(gait=SineGait(0.5, 1.0, 0.0)))
    made = found.recording
    assert len(made) == len(given_recording)
    for name in CHANNELS:
        missing = np.isnan(given_recording.values[name])
        assert ((made.flags[name] & Flag.MISSING) > 0).tolist() == missing.tolist()
    inspected = InspectedRecordings("fuzz", "", (found,))
    strict_json(inspected.record())
    assert inspected.summary()


@st.composite
def marker_files(draw):
    n = draw(st.sampled_from([1, 2, 5, 30, 120]))
    rng = np.random.default_rng(draw(st.integers(0, 2**20)))
    labels = tuple([*LAYOUT.platform1, *LAYOUT.platform2][: draw(st.integers(2, 8))])
    shape = draw(st.sampled_from(["wiggle", "constant", "noise", "nan", "huge", "mixed"]))
    size = draw(st.sampled_from([1e-6, 1.0, 1e9, 1e200]))
    names = SHAPES if shape == "mixed" else (shape,)
    columns = [channel(rng.choice(names), n, size, rng) for _ in range(3 * len(labels))]
    positions = np.stack(columns, 1).reshape(n, len(labels), 3)
    positions[rng.random((n, len(labels))) < draw(st.sampled_from([0.0, 0.3, 0.95]))] = np.nan
    t = np.arange(n) / 100
    return MarkerData("m.csv", t, np.arange(n), labels, positions, 100.0)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(marker_files(), st.booleans(), st.sampled_from([None, 1e-3]))
def test_any_marker_file_is_a_recording_or_an_error_that_says_why(data, known, sigma):
    found, said = None, ""
    try:
        found = fit_markers(data, LAYOUT if known else None, sigma)
    except InputError as error:
        said = str(error)
    if found is None:
        assert "Expected" in said
        return
    made = found.recording
    assert len(made) == len(data)
    for name in CHANNELS:
        assert (np.isnan(made.values[name]) == ((made.flags[name] & Flag.MISSING) > 0)).all()
        assert (made.sigma[name] > 0).all()
    if len(made) > 1 and not (known and set(LAYOUT.platform2).isdisjoint(data.labels)):
        found = inspect(data, None, Circumstances(layout=LAYOUT if known else None))
        strict_json(InspectedRecordings("fuzz", "", (found,)).record())


def test_markers_that_all_stand_in_one_point_are_no_robot():
    data = MarkerData("m", np.arange(9.0), np.arange(9), ("L1", "R1", "T1", "T2"),
                      np.zeros((9, 4, 3)), 1.0, None, MappingProxyType({}))  # fmt: skip
    with pytest.raises(InputError, match="Expected two rigid platforms"):
        fit_markers(data, None)
