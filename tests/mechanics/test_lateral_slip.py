"""Wheels that creep slip sideways at their side force times the compliance.

The side force is the one that held axles would take, as long as the slip is small; without creep
and with much grip the robot moves as if it could not slip at all.
Wheels that slide are held against their slip, whatever its direction: two equations for the force
and the lag of a wheel, solved by bisection, are the second way to it.
"""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from rr_opt.effects import lateral_slip
from rr_opt.effects.coulomb_friction import SMOOTHING_SPEED
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS, robot_values
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from rr_opt.motion.dynamics import assembled, dynamics_of, values_of
from rr_opt.motion.floor_motion import floor_motion
from rr_opt.motion.integrators import cvodes
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


def pushed(values, v, s1, dry=0.0):
    """Force (2, N) along and square to a wheel of platform 1 at speeds v, s1 (m/s), the robot
    straight and without yaw, its wheels with dry friction (N)."""
    friction = {"force1": dry, "force2": dry}
    uses = EffectUse("lateral_slip", values), EffectUse("coulomb_friction", friction)
    robot = replace(BENCHMARK, physics=uses)
    assembly = assembled(tuple(use.name for use in uses))
    of_first = assembly.mechanism.forces[::4]
    inputs = [assembly.mechanism.phi, assembly.mechanism.speeds, assembly.p]
    force = ca.Function("force", inputs, [sum(one.vector for one in of_first)])
    # Axle 2 slips so that the joint's ends move alike and nothing turns.
    at = [0.0, [v, s1, s1, 0.0], values_of(robot, assembly.parameters)]
    return force(*at).full().ravel()


@pytest.mark.parametrize("ratio", [0.5, 1.0])
@pytest.mark.parametrize("mu", [0.01, 0.05])
@pytest.mark.parametrize("slip", [3e-3, 0.05])
@pytest.mark.parametrize("dry", [0.0, 0.15, 3.0])
def test_sliding_wheels_turn_more_slowly(ratio, mu, slip, dry):
    v, p = 0.3, dict(zip(ROBOT_PARAMETERS, robot_values(BENCHMARK), strict=True))
    most = mu * float(lateral_slip.wheel_loads(p)[1])

    def resists(u):
        return p["k1"] * u + dry * most * np.tanh(u / SMOOTHING_SPEED)

    def yields(u):
        return np.sqrt(slip**2 + u**2 + lateral_slip.SMOOTHING_SPEED**2) / most

    u = brentq(lambda u: ratio * resists(v - ratio * u) - u / yields(u), 0.0, v / ratio)
    slides = {"creep_compliance": 0.0, "mu": mu, "mu_ratio": ratio}
    along, square = pushed(slides, v, slip, dry * most)
    assert along == pytest.approx(-resists(v - ratio * u), rel=0.01)
    assert square == pytest.approx(-slip / yields(u), rel=0.01)
    if ratio == 1.0:
        # On the circle of friction.
        assert np.hypot(along, square) <= 1.01 * most


def test_rolling_is_as_it_was_where_only_the_side_force_is_limited():
    k1 = dict(zip(ROBOT_PARAMETERS, robot_values(BENCHMARK), strict=True))["k1"]
    along, _ = pushed({"creep_compliance": 0.0, "mu": 0.01, "mu_ratio": 0.0}, 0.3, 0.05)
    assert along == pytest.approx(-0.3 * k1)
