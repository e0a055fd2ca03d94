"""The smoother is the exact conditional mean and variance, and its derivative is true."""

import numpy as np
import pytest

from rr_opt.recordings.outliers import outliers
from rr_opt.recordings.smoothing import derivatives, smoothed, strength
from tests.recordings.clean.world import GAIT, motion


def conditional(t, y, q, vague):
    """Value and first derivative given y with unit noise, and the value's variance, by Gaussian
    conditioning.

    The prior is an integrated Wiener process from a vague parabola; its covariances come from
    sampling the integral of its kernels on a fine grid, and not from a state space.
    """
    known = np.isfinite(y)
    s = (np.arange(6000) + 0.5) / 6000 * (t[-1] - t[0]) + t[0]
    u = (t - t.mean()) / 20
    since = np.maximum(t[:, None] - s, 0.0)
    parts = [since**2 / 2, since]
    weight = q * (s[1] - s[0])
    basis = [
        np.stack([np.ones_like(t), u, u**2], 1),
        np.stack([np.zeros_like(t), np.ones_like(t), 2 * u], 1) / 20,
    ]
    cross = [weight * part @ parts[0].T + vague * one @ basis[0].T
             for part, one in zip(parts, basis, strict=True)]  # fmt: skip
    own = weight * parts[0] @ parts[0].T + vague * basis[0] @ basis[0].T
    inverse = np.linalg.inv(cross[0][np.ix_(known, known)] + np.eye(known.sum()))
    means = [one[:, known] @ inverse @ y[known] for one in cross]
    return means, np.diag(own - cross[0][:, known] @ inverse @ cross[0][:, known].T)


@pytest.mark.parametrize("ratio", [1e-7, 1e2])
@pytest.mark.parametrize("least", [0.0, 1e-9, 0.01, 0.29])
def test_stamps_as_close_as_can_be_do_no_harm(ratio, least):
    rng = np.random.default_rng(1)
    t = np.cumsum(np.where(rng.random(400) < 0.4, least + 1e-12, 1.0) * 0.01)
    made = smoothed(t, np.sin(t) + 1e-3 * rng.normal(size=400), 1e-3, ratio)
    for values in (made.value, made.first, made.sigma):
        assert np.isfinite(values).all()
    assert (made.sigma <= 1.001e-3).all()
    assert np.abs(made.value - np.sin(t)).max() < 5e-3


@pytest.mark.parametrize("stamps", ["even", "uneven", "close"])
def test_it_is_what_gaussian_conditioning_gives(stamps):
    rng = np.random.default_rng(0)
    t = np.arange(40.0)
    if stamps == "uneven":
        t = t + rng.uniform(-0.3, 0.3, 40)
    if stamps == "close":
        t[[5, 12, 13, 30]] = t[4] + 1e-3, t[11] + 0.05, t[11] + 0.2, t[29] + 1e-9
    y = 5 * np.sin(t / 4) + rng.normal(0, 1, 40)
    y[[7, 20, 21, 22, 23]] = np.nan
    step = float(np.median(np.diff(t)))
    q = 2e-3
    made = smoothed(t, y, 1.0, q * step**5)
    # A vaguer prior leaves fewer digits for the variances, a firmer one pulls at the means.
    means, _ = conditional(t, y, q, 1e8)
    _, variance = conditional(t, y, q, 1e5)
    for mine, mean in zip((made.value, made.first), means, strict=True):
        # Samples that share a node share its second derivative.
        atol = 2e-2 if stamps == "close" else 2e-3
        np.testing.assert_allclose(mine, mean, rtol=2e-3, atol=atol)
    np.testing.assert_allclose(made.sigma**2, variance, rtol=2e-2)


def test_a_noisy_wiggle_is_found_within_its_sigma():
    moved, rng = motion(), np.random.default_rng(1)
    y = moved.phi + rng.normal(0, 3e-3, len(moved.t))
    y[1000:1030] = np.nan
    y[rng.random(len(y)) < 0.05] = np.nan
    made = derivatives(moved.t, y, 3e-3)
    exact, rate = GAIT.angle(moved.t), GAIT.rate(moved.t)
    assert np.mean(np.abs(made.value - exact) / made.sigma < 1.96) > 0.93
    # And it is of use: small against what it measures.
    assert np.median(made.sigma) < 0.2 * exact.std()
    assert np.abs(made.first - rate).std() < 0.2 * rate.std()


def test_a_noisier_channel_is_smoothed_more():
    moved, rng = motion(), np.random.default_rng(2)
    ratios = [
        strength(moved.phi + rng.normal(0, sigma, len(moved.t)), sigma)
        for sigma in (1e-3, 3e-3, 1e-2)
    ]
    assert ratios[0] > 3 * ratios[1] > 9 * ratios[2]


def test_too_few_samples_have_no_derivatives():
    made = derivatives(np.arange(5.0), np.array([1.0, np.nan, 2.0, np.nan, np.nan]), 1.0)
    assert np.isnan(made.first).all()


@pytest.mark.parametrize("seed", range(60))
def test_whatever_the_times_and_sigmas_are_the_arithmetic_holds(seed):
    """Steps, sizes and standard deviations over hundreds of decades; a warning is an error."""
    rng = np.random.default_rng(seed)
    n = int(rng.choice([5, 40, 300]))
    t = np.unique(np.cumsum(10.0 ** rng.uniform(-12, 6, n) if seed % 2 else rng.random(n) ** 9))
    n = len(t)
    y = rng.normal(size=n) * 10.0 ** rng.choice([-300, -12, 0, 11, 300])
    y[rng.random(n) < 0.2] = np.nan
    sigma = 10.0 ** rng.uniform(*(-300, 300) if seed % 3 else (-12, 12), n)
    with np.errstate(over="ignore", under="ignore"):
        made = derivatives(t, y, sigma)
        outliers(t, y, sigma)
    assert np.isfinite(made.value).all() or np.isfinite(y).sum() < 4
