"""Each disturbance does to a recording what it is called, and nothing to the motion."""

from dataclasses import replace

import numpy as np
import pytest

from rr_lab.case import motion_of, recorded
from rr_lab.disturbances import DISTURBANCES
from rr_lab.files import Delivery, answer, experiment_text
from rr_lab.random_case import random_case
from rr_opt.model.experiment import Flag, Noise
from rr_opt.outcome import InputError

CHANNELS = ("x", "y", "psi", "phi")
CASE = replace(random_case(3, "null", seconds=20.0, engine="planar"), noise=Noise(1e-3, 3e-3))


@pytest.fixture(scope="module")
def true():
    """Without noise."""
    return channels(replace(CASE, noise=Noise(1e-12, 1e-12)))


def channels(case):
    seen = recorded(case, 0, step=1e-3)
    return np.array([seen.values[name] for name in CHANNELS])


def error(name, true):
    """In sigma of the noise stated, (4, n)."""
    seen = channels(replace(CASE, disturbance=name))
    sigma = np.array([CASE.noise.of(channel) for channel in CHANNELS])
    return (seen - true) / sigma[:, None]


def correlation(one):
    return np.corrcoef(one[:-1], one[1:])[0, 1]


def test_without_any_the_noise_is_white(true):
    off = error("", true)
    assert np.std(off) == pytest.approx(1.0, rel=0.05)
    assert abs(correlation(off[0])) < 0.1


@pytest.mark.parametrize(("name", "most"), [("lowpass_10hz", 0.5), ("lowpass_6hz", 0.4)])
def test_filters_remove_fast_noise_and_keep_the_motion(name, most, true):
    off = error(name, true)[:, 100:-100]
    assert 0.2 < np.std(off) < most
    assert correlation(off[0]) > 0.8


def test_coloured_noise_keeps_its_size(true):
    off = error("ar1_noise", true)
    assert np.std(off) == pytest.approx(1.0, rel=0.1)
    assert np.mean([correlation(one) for one in off]) == pytest.approx(0.8, abs=0.05)


def test_two_per_cent_are_wild(true):
    wild = np.abs(error("outliers", true)) > 6
    assert wild[0].mean() == pytest.approx(0.02, abs=0.01)
    np.testing.assert_array_equal(wild[0], wild[3])


def test_a_fifth_is_lost_in_gaps():
    seen = recorded(replace(CASE, disturbance="dropouts"), 0, step=1e-3)
    lost = np.isnan(seen.values["x"])
    assert lost.mean() == pytest.approx(0.2, abs=0.1)
    np.testing.assert_array_equal(seen.flags["phi"] == Flag.MISSING, lost)
    begins = np.sum(lost[1:] & ~lost[:-1])
    assert 4 < lost.sum() / begins < 25


def test_swaps_are_mended_by_something_smooth(true):
    seen = channels(replace(CASE, disturbance="mended_swaps"))
    plain = channels(CASE)
    mended = seen[3] != plain[3]
    assert 0.01 < mended.mean() < 0.1
    third = np.abs(np.diff(seen[3], 4))
    smooth = np.all([mended[k : k + third.size] for k in range(5)], axis=0)
    assert np.median(third[smooth]) < 0.01 * np.median(third[~smooth])
    assert np.abs(seen - true)[:, mended].max() < 0.1


def test_angles_come_in_steps(true):
    seen = channels(replace(CASE, disturbance="coarse_angles"))
    assert np.abs(seen[2:] / 3e-3 - np.rint(seen[2:] / 3e-3)).max() < 1e-9
    np.testing.assert_array_equal(seen[:2], channels(CASE)[:2])


def test_a_fast_clock_stretches_the_motion():
    drifting = replace(CASE, disturbance="clock_drift")
    seen = recorded(replace(drifting, noise=Noise(1e-12, 1e-12)), 0, step=1e-3)
    plan = CASE.plans[0]
    np.testing.assert_allclose(np.diff(seen.t), 0.01, rtol=1e-9)
    assert seen.t[-1] == pytest.approx(plan.seconds, abs=0.02)
    np.testing.assert_allclose(seen.values["phi"], plan.gait.angle(seen.t / 1.01), atol=2e-4)
    assert motion_of(drifting, plan, 1e-3).t[-1] == pytest.approx(plan.seconds / 1.01, abs=0.02)


@pytest.mark.parametrize(
    ("name", "true_over_stated"), [("noise_understated", 2), ("noise_overstated", 0.5)]
)
def test_stated_noise_is_wrong_by_a_factor_of_two(name, true_over_stated, true):
    assert np.std(error(name, true)) == pytest.approx(true_over_stated, rel=0.05)


@pytest.mark.parametrize("name", DISTURBANCES)
def test_nothing_but_the_recordings_and_the_answer_shows_it(name):
    disturbed = replace(CASE, disturbance=name)
    assert experiment_text(disturbed, Delivery()) == experiment_text(CASE, Delivery())
    assert answer(disturbed) == {**answer(CASE), "disturbance": name}


def test_unknown_ones_are_refused():
    with pytest.raises(InputError, match=r"no disturbance 'rain'. Expected one of: lowpass_10hz"):
        random_case(3, "null", disturbance="rain")
