"""A marker that is not where its platform is, is left out, and told with its size and time."""

from dataclasses import replace

import numpy as np

from rr_opt.model.experiment import Flag
from rr_opt.recordings.markers.pose import fit_markers
from tests.recordings.clean.world import LAYOUT, kinds, markers, motion

SIGMA = 5e-4


def test_a_marker_that_jumps_is_left_out_and_told():
    data = markers(motion(), SIGMA, 1)
    positions = data.positions.copy()
    at = data.labels.index("T3")
    positions[321:331, at, 0] += 0.04
    found = fit_markers(replace(data, positions=positions), LAYOUT, SIGMA)
    rows = np.flatnonzero(found.ghosts.out[:, at])
    assert set(range(321, 331)) == set(rows)
    assert found.ghosts.out.sum() == 10
    text = " ".join(doubt for doubt in found.doubts)
    assert "T3" in text
    assert "t = 3.21 s" in text
    assert "40 mm" in text or "39 mm" in text or "41 mm" in text
    clean = fit_markers(data, LAYOUT, SIGMA).recording
    for name in ("x", "phi"):
        error = found.recording.values[name] - clean.values[name]
        assert np.abs(error[321:331] / clean.sigma[name][321:331]).max() < 4
        # With a marker less the motion is known less well, and the sigma says so.
        assert (found.recording.sigma["phi"][321:331] > clean.sigma["phi"][321:331]).all()


def test_a_frame_that_nothing_explains_is_flagged_and_its_values_stay():
    data = markers(motion(), SIGMA, 2)
    positions = data.positions.copy()
    positions[1000] += np.random.default_rng(0).normal(0, 0.2, positions[1000].shape)
    found = fit_markers(replace(data, positions=positions), LAYOUT, SIGMA)
    assert list(found.ghosts.lost) == [1000]
    for name in ("x", "y", "psi", "phi"):
        flags = found.recording.flags[name]
        assert flags[1000] == Flag.OUTLIER
        assert np.flatnonzero(flags).tolist() == [1000]
        assert np.isfinite(found.recording.values[name][1000])
    assert "lost" in kinds(found.doubts)


def test_noise_alone_makes_no_ghosts():
    frames = 0
    for seed in range(5):
        found = fit_markers(markers(motion(), SIGMA, seed), LAYOUT, None)
        frames += len(found.recording)
        assert not found.ghosts.out.any()
        assert not len(found.ghosts.lost)
    assert frames > 15_000
