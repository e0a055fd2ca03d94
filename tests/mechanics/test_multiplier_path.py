"""A model with Lagrange multipliers, written by hand, takes the same path with the same forces.

Both are integrated over two periods of a gait: the reduced model in (x, y, psi, v), the other
in x, y, psi, phi and their rates, at the level of accelerations. What drifts there off the
constraints is checked to be nothing.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import dynamics_of
from tests.mechanics import multipliers
from tests.mechanics.cases import REPEATABLE, State, motion, numbers, robots, sides

ACCURATE = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-11}


class Gait:
    """phi(t) = alpha sin(2 pi t/T) + phi0, with its derivatives."""

    def __init__(self, alpha: float, T: float, phi0: float):
        self.alpha, self.T, self.phi0 = alpha, T, phi0

    def __repr__(self) -> str:
        return f"Gait({self.alpha}, {self.T}, {self.phi0})"

    def __call__(self, t: float) -> tuple[float, float, float]:
        n = 2 * np.pi / self.T
        swing = self.alpha * np.sin(n * t)
        return swing + self.phi0, self.alpha * n * np.cos(n * t), -(n**2) * swing


@st.composite
def runs(draw: st.DrawFn) -> tuple[Robot, Gait, float]:
    """A robot, a gait that stays clear of its singular posture, and a speed to start at."""
    robot = draw(robots())
    room = 0.8 * robot.singular_angle
    alpha = draw(numbers(0.3, 0.8)) * room
    phi0 = draw(numbers(-1.0, 1.0)) * (room - alpha)
    return robot, Gait(alpha, draw(numbers(0.8, 2.0)), phi0), draw(numbers(-0.3, 0.3))


def reduced_path(robot: Robot, gait: Gait, v0: float, times: np.ndarray) -> np.ndarray:
    """x, y, psi, v at the times (4, n)."""
    model, p = dynamics_of(robot), dynamics_of(robot).values(robot)

    def slope(t: float, state: np.ndarray) -> list[float]:
        psi, v = state[2:]
        vdot, w, side, _ = (float(out) for out in model.motion(v, *gait(t), p))
        xdot = v * np.cos(psi) - side * np.sin(psi)
        return [xdot, v * np.sin(psi) + side * np.cos(psi), w, vdot]

    return solve_ivp(slope, times[[0, -1]], [0, 0, 0, v0], t_eval=times, **ACCURATE).y


def full_path(robot: Robot, gait: Gait, v0: float, times: np.ndarray) -> np.ndarray:
    """x, y, psi, phi and their rates at the times (8, n)."""
    phi, dphi, _ = gait(0.0)
    q = np.array([0.0, 0.0, 0.0, phi])
    start = np.concatenate([q, multipliers.rates(robot, q, v0, dphi)])

    def slope(t: float, state: np.ndarray) -> np.ndarray:
        qdd, _ = multipliers.solve(robot, state[:4], state[4:], gait(t)[2])
        return np.concatenate([state[4:], qdd])

    return solve_ivp(slope, times[[0, -1]], start, t_eval=times, **ACCURATE).y


@settings(REPEATABLE, max_examples=6)
@given(runs())
def test_two_periods_agree(run):
    robot, gait, _ = run
    times = np.linspace(0.0, 2 * gait.T, 41)
    reduced, full = reduced_path(*run, times), full_path(*run, times)
    q, qd = full[:4], full[4:]
    v = qd[0] * np.cos(q[2]) + qd[1] * np.sin(q[2])
    np.testing.assert_allclose(np.vstack([q[:3], v]), reduced, rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(q[3], [gait(t)[0] for t in times], atol=1e-7)

    for t, here, at, rate in zip(times, reduced.T, q.T, qd.T, strict=True):
        np.testing.assert_allclose(multipliers.slip(robot, at, rate), 0.0, atol=1e-7)
        F1, F2, torque = multipliers.solve(robot, at, rate, gait(t)[2])[1]
        state = State(here[3], *gait(t))
        expected = motion(robot, state).torque, *sides(robot, state)
        assert (torque, F1, F2) == pytest.approx(expected, rel=1e-5, abs=1e-6)
