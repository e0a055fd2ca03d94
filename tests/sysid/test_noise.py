"""The noise is estimated in spite of what a model lacks: its level, what its samples are worth."""

import numpy as np
import pytest
from scipy.signal import butter, lfilter, sosfiltfilt

from rr_opt.sysid.model import ChannelNoise
from rr_opt.sysid.noise import levelled, noise_of
from tests.sysid.made_up import with_effect

STEP, SAMPLES, RUNS = 0.01, 3000, 6


def white(rng):
    return rng.standard_normal(SAMPLES)


def correlated(rng):
    """Autoregressive of order 1, of unit variance; 9 samples are worth one."""
    return lfilter([0.6], [1, -0.8], rng.standard_normal(SAMPLES + 200))[200:]


def filtered(rng):
    """At 10 Hz; what is left of the variance is 1/6, and 5 to 6 samples are worth one."""
    return sosfiltfilt(butter(2, 10, fs=1 / STEP, output="sos"), white(rng))


def missing_physics(rng):
    """A drift and the harmonics of a gait, many times the noise."""
    t, gait = STEP * np.arange(SAMPLES), rng.uniform(0.6, 1.6)
    waves = sum(
        size * np.sin(2 * np.pi * k * gait * t + rng.uniform(0, 6))
        for k, size in enumerate((5.0, 2.0, 1.0), 1)
    )
    return waves + 0.5 * t


def estimated(make, *, lacking=False):
    rng = np.random.default_rng(3)
    runs = [make(rng) + (missing_physics(rng) if lacking else 0.0) for _ in range(RUNS)]
    return noise_of(runs, [STEP] * RUNS)


@pytest.mark.parametrize("lacking", [False, True])
@pytest.mark.parametrize(
    ("make", "level", "worth"), [(white, 1.0, 1.0), (correlated, 1.0, 9.0), (filtered, 0.41, 5.9)]
)
def test_level_and_worth(make, level, worth, lacking):
    noise = estimated(make, lacking=lacking)
    assert noise.level == pytest.approx(level, rel=0.1)
    assert noise.correlation == pytest.approx(worth, rel=0.4)


def test_twice_the_noise_is_not_as_stated():
    assert estimated(lambda rng: 2 * white(rng)).differs()
    assert not estimated(white, lacking=True).differs()


def test_model_error_does_not_pass_for_noise():
    """It is stated as known as long as its spectrum allows."""

    def lacking(rng):
        return white(rng) + 0.4 * np.sin(2 * np.pi * 1.1 * STEP * np.arange(SAMPLES))

    rng = np.random.default_rng(3)
    runs = [lacking(rng) for _ in range(RUNS)]
    assert np.std(np.concatenate(runs)) > 1.03
    assert levelled(runs, [STEP] * RUNS, 2.0, 1.0) == ChannelNoise()
    more = [1.3 * one for one in runs]
    told = levelled(more, [STEP] * RUNS, 2.0, 1.0).level
    assert told == pytest.approx(np.std(np.concatenate(more)), rel=1e-3)


def test_missing_samples_take_no_part():
    def gaps(rng):
        return white(rng) * (rng.uniform(size=SAMPLES) > 0.2)

    assert estimated(gaps).level == pytest.approx(1.0, rel=0.05)


def test_other_noise_is_in_units_of_that_assumed():
    model = with_effect({}, ())
    twice = (ChannelNoise(2.0), ChannelNoise(1.0, 9.0), ChannelNoise(), ChannelNoise())
    (before, after) = model.runs[0], model.with_noise(twice).with_noise(twice).runs[0]
    assert after.sigma[0] / before.sigma[0] == pytest.approx([4.0, 1.0, 1.0, 1.0])
    assert after.correlation == pytest.approx([1.0, 9.0, 1.0, 1.0])
