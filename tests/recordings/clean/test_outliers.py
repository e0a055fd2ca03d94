"""Outliers of a wiggling robot are found among 5 % of them, and good samples are left alone."""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.recordings.gaps import jumps
from rr_opt.recordings.outliers import misses, outliers, usual_noise
from tests.recordings.clean.world import motion

NOISE = {"x": 1e-3, "y": 1e-3, "psi": 3e-3, "phi": 3e-3}
GAITS = (SineGait(0.9, 0.8, 0.1), SineGait(0.4, 1.2, 0.0), SineGait(0.6, 2.0, -0.3))
MOST_FALSE = 1e-4


def seen(gait, channel, seed, share):
    """Time, samples, which are spoilt, by how many sigma (6 to 60)."""
    moved, rng = motion(30.0, gait), np.random.default_rng(seed)
    n = len(moved.t)
    spoilt = rng.random(n) < share
    size = rng.uniform(6, 60, n) * rng.choice([-1, 1], n)
    noise = rng.normal(0, 1, n) + spoilt * size
    return moved.t, getattr(moved, channel) + NOISE[channel] * noise, spoilt, np.abs(size)


def test_good_samples_are_flagged_less_than_once_in_ten_thousand():
    false = total = 0
    for seed, gait in enumerate(GAITS):
        for channel, sigma in NOISE.items():
            for share in (0.0, 0.05):
                t, y, spoilt, _ = seen(gait, channel, seed, share)
                found = outliers(t, y, np.full(len(t), sigma)).outlier
                false += (found & ~spoilt).sum()
                total += (~spoilt).sum()
    assert total > 70_000
    assert false <= MOST_FALSE * total


@pytest.mark.parametrize("sigma", [1e-6, 1e-5, 1e-4])
def test_next_to_no_noise_is_no_reason_to_suspect_the_motion(sigma):
    # Rounded at the sixth digit, as many exports are.
    rng = np.random.default_rng(3)
    for gait in GAITS:
        moved = motion(30.0, gait)
        for channel in NOISE:
            y = np.round(getattr(moved, channel) + rng.normal(0, sigma, len(moved.t)), 6)
            assert not outliers(moved.t, y, usual_noise(y)).outlier.any()
            assert jumps(y, sigma) == ()
            y[1500:] += 6e-3
            (jump,) = jumps(y, sigma)
            assert jump.row == 1499
            assert jump.size == pytest.approx(6e-3, rel=0.2)


@pytest.mark.parametrize("channel", NOISE)
def test_of_five_per_cent_those_of_twelve_sigma_are_found(channel):
    hit = planted = 0
    for seed, gait in enumerate(GAITS):
        t, y, spoilt, size = seen(gait, channel, 100 + seed, 0.05)
        found = outliers(t, y, np.full(len(t), NOISE[channel]))
        large = spoilt & (size > 12)
        hit += found.outlier[large].sum()
        planted += large.sum()
        assert abs(found.noise.sigma / NOISE[channel] - 1) < 0.12
    assert hit >= 0.98 * planted


def test_what_is_missing_is_no_outlier_and_hides_none():
    t, y, spoilt, size = seen(GAITS[0], "phi", 7, 0.02)
    gone = np.random.default_rng(8).random(len(t)) < 0.1
    gone[1000:1050] = True
    y[gone] = np.nan
    found = outliers(t, y, np.full(len(t), 3e-3)).outlier
    assert not found[gone].any()
    assert found[spoilt & ~gone & (size > 15)].mean() > 0.95
    assert (found & ~spoilt).sum() == 0


def test_two_next_to_each_other_are_both_found():
    t, y, _, _ = seen(GAITS[1], "phi", 9, 0.0)
    y[500] += 0.3
    y[501] += 0.25
    y[900] -= 0.3
    y[902] += 0.3
    found = outliers(t, y, np.full(len(t), 3e-3)).outlier
    assert np.flatnonzero(found).tolist() == [500, 501, 900, 902]


def test_where_no_sample_is_good_nothing_is_foretold():
    u, y = np.arange(20.0), np.zeros(20)
    before, after = misses(u, y, np.zeros(20, bool), np.arange(5), np.ones(20))
    assert np.isinf(before).all()
    assert np.isinf(after).all()
