"""A start, a servo at its rate limit and one at a stop bend sharply: none of it is flagged."""

import numpy as np
import pytest

from rr_opt.recordings.gaps import jumps
from rr_opt.recordings.outliers import outliers

SIGMA = 3e-3
T = np.arange(0, 60, 0.01)


def start(amplitude, period):
    since = T - 3.003
    return np.where(since < 0, 0, amplitude * np.sin(2 * np.pi * since / period))


def rate_limited(amplitude, period):
    return amplitude * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * T / period + 0.1))


def stopped(amplitude, period):
    return np.clip(amplitude * np.sin(2 * np.pi * T / period), -0.6 * amplitude, 0.6 * amplitude)


@pytest.mark.parametrize("shape", [start, rate_limited, stopped])
def test_none_is_flagged_and_no_jump_is_seen(shape):
    rng = np.random.default_rng(0)
    for _ in range(4):
        y = shape(rng.uniform(0.3, 1), rng.uniform(0.8, 2)) + rng.normal(0, SIGMA, len(T))
        found = outliers(T, y, np.full(len(T), SIGMA))
        assert not found.outlier.any()
        assert not jumps(y, SIGMA)


def test_a_jump_is_told_with_its_place_and_size():
    rng = np.random.default_rng(1)
    y = stopped(0.8, 1.1) + rng.normal(0, SIGMA, len(T))
    y[2500:] += 0.1
    (jump,) = jumps(y, SIGMA)
    assert jump.row == 2499
    assert abs(jump.size - 0.1) < 0.02
