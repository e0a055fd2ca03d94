"""Exchanged names are found and put right, however long they last; none is found where none is."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.experiment import Layout
from rr_opt.recordings.markers.pose import fit_markers
from tests.recordings.clean.world import LAYOUT, kinds, markers, motion

SIGMA = 5e-4


def exchanged(data, names, rows):
    i, j = (data.labels.index(name) for name in names)
    positions = data.positions.copy()
    positions[rows, i], positions[rows, j] = data.positions[rows, j], data.positions[rows, i]
    return replace(data, positions=positions)


def worst(fit):
    """Largest error of P and of the angles, in sigma."""
    moved, made = motion(), fit.recording
    return max(
        np.nanmax(np.abs(made.values[name] - getattr(moved, name)) / made.sigma[name])
        for name in ("x", "y", "psi", "phi")
    )


@pytest.mark.parametrize(
    ("names", "rows"),
    [
        (("L1", "R1"), slice(500, 900)),
        (("T1", "T4"), slice(700, 701)),
        (("R1", "T2"), slice(1800, None)),
        (("L2", "T3"), slice(None, 40)),
    ],
)
def test_a_swap_is_put_right(names, rows):
    data = exchanged(markers(motion(), SIGMA, 1), names, rows)
    found = fit_markers(data, LAYOUT, SIGMA)
    planted = np.arange(len(data))[rows]
    told = np.concatenate([swap.frames for swap in found.swaps])
    assert {frozenset(found.bodies.labels[i] for i in swap.members) for swap in found.swaps} == {
        frozenset(names)
    }
    assert len(np.setdiff1d(told, planted)) == 0
    # Markers that are near each other in some postures may pass for each other, within the noise.
    assert len(told) > 0.95 * len(planted)
    assert worst(found) < 5.5
    text = " ".join(doubt for doubt in found.doubts)
    assert f"{names[0]} and {names[1]}" in text
    assert "swapped labels" in text


def test_a_name_on_a_marker_whose_own_is_missing_is_put_right():
    data = markers(motion(), SIGMA, 2)
    data = exchanged(data, ("L1", "R2"), slice(100, 150))
    data.positions[100:150, data.labels.index("L1")] = np.nan
    found = fit_markers(data, LAYOUT, SIGMA)
    assert sum(len(swap.frames) for swap in found.swaps) == 50
    assert worst(found) < 5.5


def test_names_exchanged_in_the_layout_are_told_and_put_right():
    wrong = dict(LAYOUT.platform1)
    wrong["L1"], wrong["R1"] = wrong["R1"], wrong["L1"]
    found = fit_markers(markers(motion(), SIGMA, 3), Layout(wrong, LAYOUT.platform2), SIGMA)
    assert "throughout the recording" in found.doubts[0]
    assert worst(found) < 5.5


def test_a_ghost_beside_a_swap_is_not_taken_for_one():
    data = exchanged(markers(motion(), SIGMA, 5), ("L1", "R1"), slice(500, 520))
    data.positions[800:830, data.labels.index("T1"), :2] += 0.05
    found = fit_markers(data, LAYOUT, SIGMA)
    assert np.concatenate([swap.frames for swap in found.swaps]).tolist() == list(range(500, 520))
    assert np.flatnonzero(found.ghosts.out.any(axis=1)).tolist() == list(range(800, 830))
    assert worst(found) < 5.5


def test_no_swap_is_found_where_there_is_none():
    found = fit_markers(markers(motion(), SIGMA, 4), LAYOUT, SIGMA)
    assert not found.swaps
    assert not kinds(found.doubts)


@pytest.mark.parametrize(
    "names", [("L1", "R1", "L2"), ("R1", "T2", "T4"), ("L1", "R1", "T1", "T3"), ("L2", "T1", "R2")]
)
@pytest.mark.parametrize("rows", [slice(500, 900), slice(77, 78), slice(None)])
def test_three_in_a_ring_and_two_pairs_at_once_are_put_right(names, rows):
    data = markers(motion(), SIGMA, 4)
    i = [data.labels.index(name) for name in names]
    to = [i[1], i[2], i[0]] if len(i) == 3 else [i[1], i[0], i[3], i[2]]
    positions = data.positions.copy()
    positions[rows, i] = data.positions[rows][:, to]
    # Ghosts beside them do not hide them.
    positions[1500:2400:30, 3] += 0.1
    found = fit_markers(replace(data, positions=positions), LAYOUT, SIGMA)
    assert worst(found) < 5.5
    text = " ".join(doubt for doubt in found.doubts)
    assert "swapped labels" in text or "throughout the recording" in text
    assert all(name in text for name in names)
