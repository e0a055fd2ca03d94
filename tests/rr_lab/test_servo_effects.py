"""The servo's faults show in phi as their laws say."""

import math

import numpy as np
import pytest

from rr_lab.case import ENGINES, record
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.6, 1.0, 0.1)


ENGINE = pytest.mark.parametrize("engine", ENGINES)


def phi_with(name, seconds=2.0, start="running", engine="mujoco", **values):
    seen = record(LONG, GAIT, seconds, start, [EffectUse(name, values)], engine=engine)
    return seen.t, seen.values["phi"]


def play_operator(command, width):
    """The load stays until a flank reaches it."""
    load = [command[0]]
    for asked in command[1:]:
        load.append(min(max(load[-1], asked - width / 2), asked + width / 2))
    return np.array(load)


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


@pytest.mark.parametrize("start", ["rest", "running"])
def test_a_pure_delay_shifts_the_command(start):
    t, phi = phi_with("servo_lag/delay", start=start, delay=0.037)
    begin = 0.0 if start == "rest" else -math.inf
    np.testing.assert_allclose(phi, GAIT.angle(np.maximum(t - 0.037, begin)), atol=1e-6)


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


@ENGINE
def test_joint_friction_holds_the_load_in_the_play(engine):
    friction = {"width": 0.04, "joint_friction": 0.3}
    t, phi = phi_with("servo_backlash/frictional", engine=engine, **friction)
    before = np.arange(-100, 0) / 100
    command = GAIT.angle(np.concatenate([before, t]))
    np.testing.assert_allclose(phi, play_operator(command, 0.04)[100:], atol=1.5e-3)
    assert np.ptp(phi) / 2 == pytest.approx(0.6 - 0.02, abs=1e-3)


@ENGINE
def test_weak_joint_friction_is_overcome_by_inertia(engine):
    friction = {"width": 0.04, "joint_friction": 1e-4}
    _, phi = phi_with("servo_backlash/frictional", engine=engine, **friction)
    assert np.ptp(phi) / 2 == pytest.approx(0.6 + 0.02, abs=2e-3)


@ENGINE
def test_a_compliant_gear_adds_its_twist_to_the_play(engine):
    values = {"width": 0.04, "joint_friction": 0.3, "gear_stiffness": 30.0}
    _, phi = phi_with("servo_backlash/frictional_compliant", engine=engine, **values)
    # Besides friction the gear turns the load's inertia, whose torque is least at mid-swing.
    assert np.ptp(phi) / 2 == pytest.approx(0.6 - 0.02 - 0.3 / 30, abs=4e-3)


@ENGINE
def test_a_soft_position_loop_lags_by_tau(engine):
    tau, omega = 0.03, GAIT.angular_frequency
    t, phi = phi_with("servo_lag/p_loop", engine=engine, tau=tau, zeta=1.0)
    late = -np.angle(np.sum((phi - 0.1) * np.exp(-1j * omega * t))) - math.pi / 2
    assert late / omega == pytest.approx(tau, rel=0.15)


def test_clock_offset_is_a_shift_in_time():
    t, phi = phi_with("clock_offset", offset=0.037)
    np.testing.assert_allclose(phi, GAIT.angle(t + 0.037), atol=1e-6)


def test_clock_offset_shows_the_stillness_before_a_start():
    t, phi = phi_with("clock_offset", start="rest", offset=-0.3)
    np.testing.assert_allclose(phi, GAIT.angle(np.maximum(t - 0.3, 0)), atol=1e-6)
