"""The start from rest dies as told and loses the distance told, by long simulations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.model.gait import SineGait
from rr_opt.motion.circle import transient
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.integrators import cvodes
from rr_opt.motion.steady_cycle import steady_cycle
from tests.robots import BENCHMARK, DRY


@pytest.mark.parametrize("robot", [BENCHMARK, DRY], ids=["viscous", "dry"])
@pytest.mark.parametrize("offset", [0.0, 0.4])
def test_the_deviation_falls_as_told(robot, offset):
    gait = SineGait(0.7, 1.4, offset)
    steady = steady_cycle(robot, gait)
    start = transient(robot, steady)
    times = np.arange(16) * gait.period
    deviation = cvodes(robot, gait, 0.0, times)[0] - steady.v[0]
    ratio = deviation[12] / deviation[11]
    assert ratio == pytest.approx(start.factor, rel=2e-3)
    assert start.factor == pytest.approx(np.exp(-gait.period / start.constant))


@pytest.mark.parametrize("offset", [0.0, 0.4])
def test_the_distance_lost(offset):
    """By integrating P's velocity, seen from the frame that turns with each period."""
    gait = SineGait(0.7, 1.4, offset)
    steady = steady_cycle(BENCHMARK, gait)
    dynamics = dynamics_of(BENCHMARK)
    values = dynamics.values(BENCHMARK)

    def slope(t, state, turn):
        v, chi = state[:2]
        rate = (gait.angle(t), gait.rate(t), gait.acceleration(t))
        vdot, w, side, _ = (float(part) for part in dynamics.motion(v, *rate, values))
        cos, sin = np.cos(chi), np.sin(chi)
        return [vdot, w - turn / gait.period, cos * v - sin * side, sin * v + cos * side]

    def period(v0):
        """v(T) and the displacement in the turning frame, (2,)."""
        how = {"rtol": 1e-9, "atol": 1e-11, "method": "DOP853"}
        turn = solve_ivp(slope, (0, gait.period), [v0, 0, 0, 0], args=(0.0,), **how).y[1, -1]
        end = solve_ivp(slope, (0, gait.period), [v0, 0, 0, 0], args=(turn,), **how).y[:, -1]
        return end[0], end[2:]

    goal = period(float(steady.v[0]))[1]
    length, lost, v = np.hypot(*goal), 0.0, 0.0
    for _ in range(32):
        v, step = period(v)
        lost += length - step @ goal / length
    start = transient(BENCHMARK, steady)
    assert length == pytest.approx(abs(steady.speed) * gait.period, rel=1e-7)
    assert lost == pytest.approx(start.lost, rel=1e-4)
    assert start.delay == pytest.approx(start.lost / abs(steady.speed), rel=1e-7)
