"""Gaits of every shape say the truth about themselves: derivatives, mean, extremes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rr_opt.model.gait import FourierGait, FreeGait, Gait, SineGait

SMALL = st.floats(-0.5, 0.5)


@st.composite
def fourier(draw: st.DrawFn) -> FourierGait:
    n = draw(st.integers(1, 6))
    sines, cosines = (tuple(draw(SMALL) for _ in range(n)) for _ in range(2))
    return FourierGait(draw(st.floats(0.3, 3)), draw(SMALL), sines, cosines)


@st.composite
def free(draw: st.DrawFn) -> FreeGait:
    n = draw(st.integers(3, 24))
    u = np.array([draw(st.floats(-50, 50)) for _ in range(n)])
    u -= u.mean()
    T = draw(st.floats(0.3, 3))
    # The rate at the start for which phi closes.
    h = T / n
    drift = (np.cumsum(np.concatenate([[0.0], h * u[:-1]])) + h * u / 2).mean()
    return FreeGait(T, draw(SMALL), float(-drift), tuple(u))


GAITS = st.one_of(fourier(), free())


@given(GAITS)
def test_rate_and_acceleration_are_derivatives(gait: Gait) -> None:
    n = gait.pieces if gait.pieces > 1 else 24
    t = (np.arange(n) + 0.5) * gait.period / n
    h = 1e-4 * gait.period / n
    scale = 1 + np.abs(gait.acceleration(t)).max()
    rate = (gait.angle(t + h) - gait.angle(t - h)) / (2 * h)
    acceleration = (gait.rate(t + h) - gait.rate(t - h)) / (2 * h)
    assert rate == pytest.approx(gait.rate(t), abs=1e-5 * scale)
    assert acceleration == pytest.approx(gait.acceleration(t), abs=1e-4 * scale)


@given(GAITS)
def test_period_offset_and_extremes(gait: Gait) -> None:
    t = np.linspace(0, gait.period, 20_001)
    phi, rate = gait.angle(t), gait.rate(t)
    assert phi[-1] == pytest.approx(phi[0], abs=1e-8)
    middle = (t[:-1] + t[1:]) / 2
    assert gait.offset == pytest.approx(gait.angle(middle).mean(), abs=1e-5)
    for claimed, seen in (
        (gait.amplitude, np.abs(phi - gait.offset).max()),
        (gait.peak_angle, np.abs(phi).max()),
        (gait.peak_rate, np.abs(rate).max()),
    ):
        assert seen <= claimed * (1 + 1e-8) + 1e-8
        assert claimed <= seen * (1 + 1e-3) + 1e-5


def test_one_harmonic_is_the_sine() -> None:
    t = np.linspace(0, 2, 50)
    sine, same = SineGait(0.4, 1.3, 0.1), FourierGait(1.3, 0.1, (0.4,), (0.0,))
    assert same.angle(t) == pytest.approx(sine.angle(t), abs=1e-15)
    assert same.peak_angle == pytest.approx(sine.peak_angle, rel=1e-12)
    assert same.peak_rate == pytest.approx(sine.peak_rate, rel=1e-12)
    assert same.amplitude == pytest.approx(sine.amplitude, rel=1e-12)
