"""The equation of motion of a gait as CasADi integrators: fixed steps, and cvodes.

Both carry the state (v, psi, x, y, s) with s = dv/dv(0) the sensitivity that closes a cycle.
cvodes at tight tolerance is the reference that everything else is held against.
"""

from __future__ import annotations

import math
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.motion.tableau import BUTCHER6, Tableau
from rr_opt.physics.dynamics import derive, dynamics_of
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

STATE = ("v", "psi", "x", "y", "s")


def fixed_steps(
    robot: Robot,
    gait: SineGait,
    v0: float,
    *,
    steps: int,
    end: float | None = None,
    method: Tableau = BUTCHER6,
) -> Array:
    """States (5, steps + 1) at equal steps from t = 0 to `end` (one period), from v(0) = v0."""
    dynamics = dynamics_of(robot)
    path = _path(dynamics.effects, method, steps)
    h = (end or gait.period) / steps
    start = np.array([v0, 0.0, 0.0, 0.0, 1.0])
    t = np.arange(steps) * h
    inputs = _inputs(robot, gait)
    out = path(start, t[None, :], np.full((1, steps), h), np.tile(inputs[:, None], steps))
    return np.hstack([start[:, None], np.asarray(out)])


def cvodes(robot: Robot, gait: SineGait, v0: float, times: ArrayLike) -> Array:
    """States (5, len(times)) at `times` (s, increasing from 0) by CVODES at 1e-12, relative."""
    times = np.asarray(times, float)
    dynamics = dynamics_of(robot)
    state, t, p, rhs = _symbols(dynamics.effects)
    integrator = ca.integrator(
        "reference",
        "cvodes",
        {"x": state, "t": t, "p": p, "ode": rhs},
        0.0,
        times[1:],
        {"reltol": 1e-12, "abstol": 1e-13, "max_num_steps": 10_000_000},
    )
    start = np.array([v0, 0.0, 0.0, 0.0, 1.0])
    out = integrator(x0=start, p=_inputs(robot, gait))["xf"]
    return np.hstack([start[:, None], np.asarray(out)])


def _inputs(robot: Robot, gait: SineGait) -> Array:
    values = dynamics_of(robot).values(robot)
    return np.array([gait.amplitude, gait.period, gait.offset, *values])


@lru_cache
def _stepper(effects: tuple[str, ...], method: Tableau) -> ca.Function:
    state, t, p, rhs = _symbols(effects)
    slope = ca.Function("slope", [state, t, p], [rhs])
    h = ca.SX.sym("h")
    end = method.step(lambda fraction, y: slope(y, t + fraction * h, p), state, h)
    return ca.Function("step", [state, t, h, p], [ca.cse(end)])


@lru_cache
def _path(effects: tuple[str, ...], method: Tableau, steps: int) -> ca.Function:
    return _stepper(effects, method).mapaccum(steps)


@lru_cache
def _symbols(effects: tuple[str, ...]) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    dynamics = derive(effects)
    state = ca.SX.sym("state", len(STATE))
    v, psi, _, _, s = ca.vertsplit(state)
    t, p = ca.SX.sym("t"), ca.SX.sym("p", 3 + len(dynamics.parameters))
    amplitude, period, offset = p[0], p[1], p[2]
    omega = 2 * math.pi / period
    sine, cosine = ca.sin(omega * t), ca.cos(omega * t)
    vdot, w, side, _ = dynamics.motion(
        v,
        amplitude * sine + offset,
        amplitude * omega * cosine,
        -amplitude * omega**2 * sine,
        p[3:],
    )
    rhs = ca.vertcat(
        vdot,
        w,
        v * ca.cos(psi) - side * ca.sin(psi),
        v * ca.sin(psi) + side * ca.cos(psi),
        ca.jacobian(vdot, v) * s,
    )
    return state, t, p, rhs
