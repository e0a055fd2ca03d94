"""How fast a signal may bend is found from the signal, by the likelihood of its innovations."""

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from rr_opt.recordings.smoothing import diffusion, innovations, strength, transition


def drawn(q, n, seed):
    """A signal with a white third derivative of strength q, by summing up small steps."""
    rng, fine = np.random.default_rng(seed), 20
    third = rng.normal(0, np.sqrt(q / fine), n * fine)
    second = np.cumsum(third)
    first = np.cumsum(second) / fine
    return (np.cumsum(first) / fine)[::fine]


@pytest.mark.parametrize("ratio", [1e-6, 1e-3, 0.1, 10.0])
def test_the_innovations_have_the_riccati_equation_s_variance(ratio):
    A, Q = transition(np.ones(1))[0], ratio * diffusion(np.ones(1))[0]
    H = np.array([[1.0, 0.0, 0.0]])
    P = solve_discrete_are(A.T, H.T, Q, np.eye(1))
    assert innovations(np.zeros(5), ratio)[1] == pytest.approx(P[0, 0] + 1, rel=1e-6)


@pytest.mark.parametrize("ratio", [1e-4, 1e-2, 1.0])
def test_the_innovations_of_such_a_signal_are_white_with_that_variance(ratio):
    y = drawn(ratio, 4000, 1) + np.random.default_rng(2).normal(0, 1, 4000)
    off, variance = innovations(y, ratio)
    off = off[100:]
    assert off.var() / variance == pytest.approx(1, abs=0.08)
    for lag in range(1, 6):
        assert abs(np.corrcoef(off[lag:], off[:-lag])[0, 1]) < 0.05


@pytest.mark.parametrize("ratio", [1e-5, 1e-3, 0.1])
def test_the_strength_of_a_drawn_signal_is_found(ratio):
    found = []
    for seed in range(6):
        noise = np.random.default_rng(100 + seed).normal(0, 2e-3, 3000)
        found.append(strength(2e-3 * drawn(ratio, 3000, seed) + noise, 2e-3))
    assert np.exp(np.mean(np.log(found))) / ratio == pytest.approx(1, abs=0.35)
