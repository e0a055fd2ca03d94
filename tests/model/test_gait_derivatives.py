"""The gait's rate and acceleration are the derivatives of its angle, equation (5)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rr_opt.model.gait import SineGait
from tests.mechanics.cases import REPEATABLE, numbers

gaits = st.builds(
    SineGait, amplitude=numbers(0.05, 2.6), period=numbers(0.3, 3.0), offset=numbers(-1.0, 1.0)
)


@REPEATABLE
@given(gaits)
def test_angle_is_the_papers(gait):
    t = np.linspace(-1.0, 4.0, 23)
    angle = gait.amplitude * np.sin(2 * np.pi * t / gait.period) + gait.offset
    np.testing.assert_allclose(gait.angle(t), angle, rtol=0, atol=1e-12)
    np.testing.assert_allclose(gait.angle(t + gait.period), gait.angle(t), rtol=0, atol=1e-12)


@REPEATABLE
@given(gaits)
def test_finite_differences(gait):
    t = np.linspace(0.0, gait.period, 37)
    step = 1e-4 * gait.period
    n = 2 * np.pi / gait.period
    for function, derivative, size in (
        (gait.angle, gait.rate, gait.amplitude * n),
        (gait.rate, gait.acceleration, gait.amplitude * n**2),
    ):
        slope = (function(t + step) - function(t - step)) / (2 * step)
        np.testing.assert_allclose(slope, derivative(t), rtol=0, atol=1e-6 * size)


def test_shapes_follow_the_times():
    gait = SineGait(0.5, 1.0)
    for function in (gait.angle, gait.rate, gait.acceleration):
        assert np.shape(function(0.25)) == ()
        assert np.shape(function([[0.0, 0.1]])) == (1, 2)
    assert gait.angle(0.25) == pytest.approx(0.5)
