"""Two markers of a platform are enough, one is not, and what is missing stays missing."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.experiment import Flag, Layout
from rr_opt.outcome import InputError
from rr_opt.recordings.markers.pose import fit_markers
from tests.recordings.clean.world import LAYOUT, markers, motion

SIGMA = 5e-4


def without(names, rows):
    data = markers(motion(), SIGMA, 1)
    positions = data.positions.copy()
    for name in names:
        positions[rows, data.labels.index(name)] = np.nan
    return fit_markers(replace(data, positions=positions), LAYOUT, SIGMA).recording


def test_two_of_each_are_enough():
    made = without(("L1", "R1", "T1", "T2"), slice(1000, 2000))
    for name in ("x", "y", "psi", "phi"):
        assert not made.flags[name].any()
        off = (made.values[name] - getattr(motion(), name)) / made.sigma[name]
        assert np.abs(off).max() < 5


def test_with_one_of_platform_2_phi_is_missing_and_only_phi():
    made = without(("T1", "T2", "T3"), slice(1000, 1100))
    assert (made.flags["phi"][1000:1100] == Flag.MISSING).all()
    assert np.isnan(made.values["phi"][1000:1100]).all()
    assert made.flags["phi"].sum() == 100
    for name in ("x", "y", "psi"):
        assert not made.flags[name].any()


def test_with_one_of_platform_1_only_p_is_known():
    made = without(("L1", "R1", "L2"), slice(1000, 1100))
    assert not made.flags["x"].any()
    assert (made.flags["psi"][1000:1100] == Flag.MISSING).all()
    assert (made.flags["phi"][1000:1100] == Flag.MISSING).all()


def test_turns_are_counted_across_a_gap():
    made = without(LAYOUT.platform1 | LAYOUT.platform2, slice(1000, 1010))
    assert np.isnan(made.values["x"][1000:1010]).all()
    for name in ("psi", "phi"):
        assert np.nanmax(np.abs(made.values[name] - getattr(motion(), name))) < 0.05


def test_a_layout_with_other_names_is_refused_in_three_sentences():
    data = markers(motion(), SIGMA, 1)
    with pytest.raises(InputError, match=r"The file has the markers L1.*Expected.*Correct"):
        fit_markers(data, Layout({"A": (0, 0), "B": (0, 1)}, {"C": (0, 0)}))


def test_a_frame_turned_on_its_side_is_read_by_the_axis_that_is_up():
    data = markers(motion(), SIGMA, 1)
    # y up: the floor's x and y are the capture's z and x.
    turned = data.positions[..., [1, 2, 0]]
    upright = fit_markers(data, LAYOUT, SIGMA).recording
    aside = Layout(LAYOUT.platform1, LAYOUT.platform2, up="y")
    made = fit_markers(replace(data, positions=turned), aside, SIGMA).recording
    for name in ("x", "y", "psi", "phi"):
        np.testing.assert_allclose(made.values[name], upright.values[name], atol=1e-12)
