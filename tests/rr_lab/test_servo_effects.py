"""The servo's faults show in phi as their laws say."""

import math

import numpy as np
import pytest

from rr_lab.engines import record
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.6, 1.0, 0.1)


def phi_with(name, seconds=2.0, start="running", **values):
    seen = record(LONG, GAIT, seconds, start, [EffectUse(name, values)])
    return seen.t, seen.values["phi"]


def test_lag_turns_and_shrinks_the_sine():
    tau, omega = 0.05, GAIT.angular_frequency
    t, phi = phi_with("servo_lag", tau=tau)
    late = math.atan(omega * tau)
    expected = 0.1 + 0.6 / math.hypot(1, omega * tau) * np.sin(omega * t - late)
    np.testing.assert_allclose(phi, expected, atol=1e-5)


def test_lag_of_second_order_turns_further():
    tau, beta, omega = 0.05, 1e-3, GAIT.angular_frequency
    t, phi = phi_with("servo_lag", tau=tau, beta=beta)
    answer = 1 / (1 - beta * omega**2 + 1j * omega * tau)
    expected = 0.1 + 0.6 * abs(answer) * np.sin(omega * t + np.angle(answer))
    np.testing.assert_allclose(phi, expected, atol=2e-5)


def test_rate_limit_is_kept_and_used():
    t, phi = phi_with("servo_rate_limit", rate_limit=2.0)
    rate = np.diff(phi) / np.diff(t)
    assert rate.max() == pytest.approx(2.0, rel=1e-3)
    assert rate.min() == pytest.approx(-2.0, rel=1e-3)


def test_offset_is_added():
    t, phi = phi_with("servo_offset", offset=0.03)
    np.testing.assert_allclose(phi, GAIT.angle(t) + 0.03, atol=1e-6)


def test_play_lets_the_platform_swing_on():
    t, phi = phi_with("servo_backlash", width=0.04)
    beyond = phi - GAIT.angle(t)
    assert np.abs(beyond).max() == pytest.approx(0.02, rel=0.05)
    # Driven by inertia the platform runs ahead: the amplitude grows by half the play.
    assert np.ptp(phi) / 2 == pytest.approx(0.6 + 0.02, abs=2e-3)


def test_clock_offset_is_a_shift_in_time():
    t, phi = phi_with("clock_offset", offset=0.037)
    np.testing.assert_allclose(phi, GAIT.angle(t + 0.037), atol=1e-6)


def test_clock_offset_shows_the_stillness_before_a_start():
    t, phi = phi_with("clock_offset", start="rest", offset=-0.3)
    np.testing.assert_allclose(phi, GAIT.angle(np.maximum(t - 0.3, 0)), atol=1e-6)
