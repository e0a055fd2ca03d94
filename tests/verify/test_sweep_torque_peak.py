"""The peak torque of the sweep is that of the curve, not of the samples it is computed from."""

import numpy as np
import pytest

from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify.fourier import peak
from rr_opt.verify.steady_fourier import SteadyFourier
from tests.robots import BENCHMARK

PHASES = np.linspace(0, 0.98, 50)
WAVE = 2.0
"""Two harmonics whose largest sum is 2 whatever their phase."""


@pytest.mark.parametrize("flipping", [True, False])
@pytest.mark.parametrize("n", [16, 32, 256])
def test_a_peak_between_samples(n, flipping):
    theta = np.arange(n)[:, None] * (np.pi if flipping else 2 * np.pi) / n + PHASES
    x = 1.5 * np.cos(theta) + 0.5 * np.cos(3 * theta)
    at_samples = np.abs(x).max(axis=0)
    assert peak(x, flipping) == pytest.approx(WAVE, rel=2e-6)
    if n == 16:
        assert at_samples.min() < WAVE * (1 - 5e-3)


@pytest.mark.parametrize(("offset", "n"), [(0.0, 32), (0.3, 64)], ids=["straight", "turning"])
def test_the_same_from_few_samples_as_from_many(offset, n):
    dynamics = dynamics_of(BENCHMARK)
    model, p = SteadyFourier(dynamics), dynamics.values(BENCHMARK)[:, None]
    shape = np.array([0.9]), np.array([offset]), np.array([[1.1, 1.9]])
    few, many = (model.cycles(*shape, p, k, offset == 0).peak_torque for k in (n, 4096))
    assert few == pytest.approx(many, rel=5e-6)
