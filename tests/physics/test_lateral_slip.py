"""Wheels that creep slip sideways at their side force times the compliance.

The side force is the one that held axles would take, as long as the slip is small; without creep
and with much grip the robot moves as if it could not slip at all.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.motion.integrator import cvodes
from rr_opt.physics.assembly import values_of
from rr_opt.physics.dynamics import dynamics_of
from rr_opt.physics.floor_motion import floor_motion
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import EffectUse
from tests.robots import BENCHMARK

GAIT = SineGait(0.6, 1.0, 0.15)
TIMES = np.linspace(0.0, 1.0, 41)


def driven(creep: float, mu: float):
    """States (6, n) at TIMES of a robot that slips, by an implicit method."""
    use = EffectUse("lateral_slip", {"creep_compliance": creep, "mu": mu})
    robot = replace(BENCHMARK, physics=(use,))
    motion = floor_motion(("lateral_slip",))
    p = values_of(robot, motion.parameters)

    def command(t: float) -> list[float]:
        at = np.array([t])
        return [float(part(at)[0]) for part in (GAIT.angle, GAIT.rate, GAIT.acceleration)]

    def slope(t: float, state: np.ndarray) -> np.ndarray:
        return motion.rates(state, command(t), p).full().ravel()

    start = [0.0, 0.0, 0.0, 0.1, 0.0, 0.0]
    ends = TIMES[[0, -1]]
    return solve_ivp(slope, ends, start, "Radau", TIMES, rtol=1e-7, atol=1e-9).y


def side_forces(state: np.ndarray, t: float) -> np.ndarray:
    """On the axles if they were held, N."""
    model, at = dynamics_of(BENCHMARK), np.array([t])
    command = [float(part(at)[0]) for part in (GAIT.angle, GAIT.rate, GAIT.acceleration)]
    return np.array([float(F) for F in model.sides(state[3], *command, model.values(BENCHMARK))])


def test_slip_is_force_times_compliance():
    creep = 5e-4
    path = driven(creep, 10.0)
    forces = np.array([side_forces(s, t) for s, t in zip(path.T, TIMES, strict=True)]).T
    # Each axle has two wheels; the first instants are how the slip sets in.
    slip, expected = path[4:, 4:], -creep / 2 * forces[:, 4:]
    assert np.abs(slip - expected).max() < 0.02 * np.abs(expected).max()


def test_firm_grip_holds():
    firm, firmer = (driven(creep, 10.0)[:3, -1] for creep in (4e-4, 2e-4))
    held = motion_without_slip()
    # What is left falls with the compliance, to first order.
    assert firmer - held == pytest.approx((firm - held) / 2, rel=0.1, abs=1e-6)


def motion_without_slip() -> np.ndarray:
    """x, y, psi at the end of the gait's period, of held axles."""
    _, psi, x, y, _ = cvodes(BENCHMARK, GAIT, 0.1, TIMES)[:, -1]
    return np.array([x, y, psi])
