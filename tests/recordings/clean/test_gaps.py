"""Gaps are found as they are, and bridged only where they are short."""

import numpy as np

from rr_opt.model.experiment import CHANNELS, Flag, Recording
from rr_opt.recordings.gaps import bridged, gaps, runs


def test_rows_that_the_file_lacks_are_a_gap_of_no_channel():
    t = np.delete(np.arange(100) * 0.01, range(40, 50))
    none = {name: np.zeros(90) for name in CHANNELS}
    flags = {name: np.zeros(90, np.uint8) for name in CHANNELS}
    flags["x"][:3] = Flag.MISSING
    first, second = gaps(Recording("r", t, none, none, flags))
    assert (first.channels, first.samples, first.start) == (("x",), 3, 0.0)
    assert (second.channels, second.samples) == ((), 10)
    assert abs(second.length - 0.11) < 1e-12


def test_a_short_gap_is_bridged_by_a_line_and_a_long_one_or_an_open_one_is_not():
    t = np.arange(100) * 0.01
    y = 2 * t
    y[10:15] = y[50:80] = y[:2] = y[98:] = np.nan
    bridge = bridged(t, y)
    np.testing.assert_allclose(bridge[10:15], 2 * t[10:15])
    assert np.isnan(bridge[50:80]).all()
    assert np.isnan(bridge[[0, 1, 98, 99]]).all()


def test_runs_are_counted_at_the_ends_too():
    assert runs(np.array([1, 0, 1, 1, 0, 1], bool)) == [(0, 1), (2, 4), (5, 6)]
    assert runs(np.zeros(3, bool)) == []
