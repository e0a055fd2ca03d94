"""The limited servo keeps its limit; a slow command is followed, a fast one becomes a triangle."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_paper.calibration.cycles import TAU, limited
from rr_paper.publication import RATE_LIMIT
from rr_paper.signs import sine

N = 256
AMPLITUDES, PERIODS = np.array([0.25, 0.8, 1.4]), np.array([2.0, 1.0, 1.0])


def test_no_faster_than_the_limit():
    assert np.abs(limited(AMPLITUDES, PERIODS, N).rate).max() <= RATE_LIMIT


def test_a_slow_command_is_followed():
    slow, period = np.array([0.1]), np.array([2.0])
    made, asked = limited(slow, period, N), sine(slow, period, N)
    assert np.abs(made.phi).max() == pytest.approx(np.abs(asked.phi).max(), rel=0.02)


def test_a_fast_command_becomes_a_triangle():
    made = limited(np.array([1.4]), np.array([1.0]), N)
    assert np.abs(made.phi).max() == pytest.approx(RATE_LIMIT / 4, rel=0.05)
    assert np.median(np.abs(made.rate)) == pytest.approx(RATE_LIMIT, rel=0.01)


@pytest.mark.parametrize(("amplitude", "period"), [*zip(AMPLITUDES, PERIODS, strict=True)])
def test_it_is_the_solution_of_its_equation(amplitude: float, period: float):
    omega = 2 * np.pi / period

    def rate(t: float, phi: np.ndarray) -> np.ndarray:
        return RATE_LIMIT * np.tanh((amplitude * np.sin(omega * t) - phi) / (RATE_LIMIT * TAU))

    t = 20 * period + (np.arange(N) + 0.5) * period / 2 / N
    found = solve_ivp(rate, (0, t[-1]), [0.0], t_eval=t, rtol=1e-8, atol=1e-10, method="LSODA")
    made = limited(np.array([amplitude]), np.array([period]), N)
    assert made.phi[:, 0] == pytest.approx(found.y[0], abs=2e-3)
    slope = np.gradient(made.phi[:, 0], period / 2 / N)
    assert made.rate[2:-2, 0] == pytest.approx(slope[2:-2], abs=0.05)
    bend = np.gradient(made.rate[:, 0], period / 2 / N)
    assert made.acceleration[2:-2, 0] == pytest.approx(bend[2:-2], abs=0.03 * np.abs(bend).max())
