"""The noise is estimated from the data with its own error, and a filter upstream is told."""

import numpy as np
import pytest
from scipy.signal import butter, sosfilt, sosfiltfilt

from rr_opt.recordings.noise import noise_of
from tests.recordings.clean.world import motion

SIGMA = 3e-3


def seen(seed, sigma=SIGMA, channel="phi"):
    moved = motion()
    return getattr(moved, channel) + np.random.default_rng(seed).normal(0, sigma, len(moved.t))


@pytest.mark.parametrize(("channel", "sigma"), [("x", 1e-3), ("psi", 3e-3), ("phi", 3e-3)])
def test_the_estimate_is_right_within_its_error(channel, sigma):
    found = [noise_of(seen(seed, sigma, channel)) for seed in range(60)]
    scaled = np.array([(one.sigma - sigma) / one.error for one in found])
    assert abs(scaled.mean()) < 0.6
    assert 0.75 < scaled.std() < 1.35
    assert np.mean([one.error for one in found]) < 0.035 * sigma


def test_white_noise_is_called_coloured_as_rarely_as_its_p_value_says():
    p = np.array([noise_of(seen(seed)).p_white for seed in range(150)])
    assert (p < 0.01).sum() <= 6
    assert 0.3 < np.median(p) < 0.7


@pytest.mark.parametrize("cutoff", [12.0, 20.0, 30.0])
@pytest.mark.parametrize("filtered", [sosfilt, sosfiltfilt])
def test_a_filter_upstream_shows(cutoff, filtered):
    sections = butter(2, cutoff, fs=100.0, output="sos")
    noise = noise_of(filtered(sections, seen(1))[100:])
    assert noise.p_white < 1e-6
    assert noise.colour > 1.3


def test_outliers_and_gaps_hardly_count():
    y, rng = seen(2), np.random.default_rng(3)
    y[rng.random(len(y)) < 0.01] += 1.0
    y[rng.random(len(y)) < 0.02] = np.nan
    assert abs(noise_of(y).sigma / SIGMA - 1) < 0.1


def test_too_few_samples_say_nothing():
    assert np.isnan(noise_of(np.arange(12.0)).sigma)
    assert noise_of(np.zeros(500)).sigma == 0
