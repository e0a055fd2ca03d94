"""The equation of motion of a gait as CasADi integrators: fixed steps, and CVODES.

Both carry the state (v, psi, x, y, s), where s = dv/dv(0) is the sensitivity that closes a cycle.
CVODES at tight tolerance is the reference that everything else is checked against.

No method of high order may step across a jump of the servo's acceleration. So a gait is a sequence
of pieces between jumps, which differ in their coefficients alone: one expression in time serves
them all, and gaits of one form share what is compiled from it. A smooth gait is one piece.
"""

import math
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.mechanics.runge_kutta import BUTCHER6, Tableau
from rr_opt.model.gait import FourierGait, FreeGait, Gait, SineGait
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import derive, dynamics_of
from rr_opt.outcome import NotConvergedError

STATE = ("v", "psi", "x", "y", "s")

_SNAP = 1e-9
"""A time this near to the end of a piece, relative to its length, is that end."""

_STABLE, _LOOKED_AT = 2.0, 33
"""Decay over a step up to which steps of order 6 are stable, with a margin; and times of a period
at which it is checked."""

_TIGHT, TIGHTEST = 1e-12, 1e-14
"""Tolerances of CVODES, relative."""

_STIFF = 20.0
"""Decay over a period from which the equation counts as stiff. Below it Adams' method, which has
order 12 and solves no linear system, was 1.4 to 4 times faster than BDF, of order 5; above it,
faster or slower (Hindmarsh et al., SUNDIALS, 2005)."""


def _command(harmonics: int, t: ca.SX, coefficients: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """phi (rad), dphi/dt (rad/s) and d2phi/dt2 (rad/s2) on a piece at t (s), from `_pieces`."""
    if not harmonics:
        angle, rate, acceleration = ca.vertsplit(coefficients)
        return angle + t * (rate + t * acceleration / 2), rate + t * acceleration, acceleration
    period, offset, *amplitudes = ca.vertsplit(coefficients)
    phi, dphi, ddphi = offset, ca.SX(0), ca.SX(0)
    for n in range(1, harmonics + 1):
        omega = 2 * math.pi * n / period
        sine, cosine = amplitudes[n - 1], amplitudes[harmonics + n - 1]
        s, c = ca.sin(omega * t), ca.cos(omega * t)
        phi += sine * s + cosine * c
        dphi += omega * (sine * c - cosine * s)
        ddphi -= omega**2 * (sine * s + cosine * c)
    return phi, dphi, ddphi


def _pieces(gait: Gait) -> tuple[int, Array]:
    """The harmonics of a gait that is a Fourier series, 0 if it consists of parabolas, and the
    coefficients of each piece, (.., gait.pieces).

    They are period, offset, sines and cosines, with t = 0 where the gait begins; or phi, its rate
    and its acceleration at t = 0, where the piece begins.
    """
    match gait:
        case SineGait():
            return 1, np.array([[gait.period], [gait.offset], [gait.amplitude], [0.0]])
        case FourierGait():
            coefficients = [gait.period, gait.offset, *gait.sines, *gait.cosines]
            return gait.harmonics, np.array(coefficients)[:, None]
        case FreeGait():
            angles, rates = gait.nodes
            return 0, np.array([angles[:-1], rates[:-1], gait.accelerations])
        case _:
            raise TypeError(f"no expression is known for a gait of shape {gait.shape!r}")


def whole_steps(gait: Gait, steps: int) -> int:
    """The least number of equal steps per period, at least `steps`, that meet all jumps."""
    return gait.pieces * math.ceil(steps / gait.pieces)


def fixed_steps(
    robot: Robot, gait: Gait, v0: float, *, steps: int, method: Tableau = BUTCHER6
) -> Array:
    """States (5, n + 1) over one period from v(0) = v0, at n = whole_steps(gait, steps), or a
    multiple of it that is stable."""
    dynamics = dynamics_of(robot)
    harmonics, coefficients = _pieces(gait)
    n = whole_steps(gait, steps)
    n *= max(math.ceil(_fastest_decay(robot, gait) * gait.period / n / _STABLE), 1)
    each, h = n // gait.pieces, gait.period / n
    path = _path(dynamics.effects, harmonics, method, n)
    t = np.tile(np.arange(each) * h, gait.pieces)
    values = np.tile(dynamics.values(robot)[:, None], n)
    inputs = np.vstack([np.repeat(coefficients, each, axis=1), values])
    out = path(_start(v0), t[None], np.full((1, n), h), inputs)
    return np.column_stack([_start(v0), np.asarray(out)])


def _fastest_decay(robot: Robot, gait: Gait) -> float:
    """The largest rate at which viscous friction damps a deviation of v, 1/s; 0 for other kinds of
    friction, whose rate depends on v."""
    dynamics = dynamics_of(robot)
    if not dynamics.linear:
        return 0.0
    t = np.tile(np.linspace(0.0, gait.period, _LOOKED_AT), 2)
    v = np.repeat([0.0, 1.0], _LOOKED_AT)
    inputs = np.vstack([v, gait.angle(t), gait.rate(t), gait.acceleration(t)])
    values = np.tile(dynamics.values(robot)[:, None], len(t))
    still, moving = np.asarray(dynamics.motion(*inputs[:, None], values)[0]).reshape(2, -1)
    return float((still - moving).max())


def cvodes(
    robot: Robot, gait: Gait, v0: float, times: ArrayLike, tolerance: float = _TIGHT
) -> Array:
    """States (5, len(times)) at `times` (s, increasing from 0) by CVODES; tolerance: relative.

    Raises NotConvergedError where it cannot go on.
    """
    times = np.asarray(times, float)
    dynamics = dynamics_of(robot)
    harmonics, coefficients = _pieces(gait)
    values = dynamics.values(robot)
    stiff = not dynamics.linear or _fastest_decay(robot, gait) * gait.period > _STIFF
    length = gait.period / gait.pieces if gait.pieces > 1 else float(times[-1])
    at = times[1:] / length
    at = np.where(np.abs(at - np.round(at)) < _SNAP, np.round(at), at)
    piece = np.ceil(at).astype(int) - 1
    states, state = [_start(v0)[:, None]], _start(v0)
    for k in range(piece[-1] + 1):
        inside = slice(*np.searchsorted(piece, [k, k + 1]))
        # Rounded, so that pieces with the same grid share an integrator.
        grid = tuple(np.round(at[inside] - k, 12))
        grid += () if grid and grid[-1] == 1.0 else (1.0,)
        integrator = _cvodes(dynamics.effects, harmonics, grid, tolerance, stiff)
        p = np.concatenate([[length], coefficients[:, k % gait.pieces], values])
        try:
            out = np.asarray(integrator(x0=state, p=p)["xf"])
        except RuntimeError as error:
            raise NotConvergedError(
                f"The motion cannot be integrated from t = {k * length:.4g} s to "
                f"{(k + 1) * length:.4g} s: it is too fast or unbounded. Expected a robot of "
                "plausible size. `rr-opt lint` shows which values are not."
            ) from error
        states.append(out[:, : inside.stop - inside.start])
        state = out[:, -1]
    return np.hstack(states)


def _start(v0: float) -> Array:
    return np.array([v0, 0.0, 0.0, 0.0, 1.0])


@lru_cache
def _path(effects: tuple[str, ...], harmonics: int, method: Tableau, steps: int) -> ca.Function:
    return _stepper(effects, harmonics, method).mapaccum(steps)


@lru_cache
def _stepper(effects: tuple[str, ...], harmonics: int, method: Tableau) -> ca.Function:
    state, t, p, rhs = _symbols(effects, harmonics)
    slope = ca.Function("slope", [state, t, p], [rhs])
    h = ca.SX.sym("h")
    end = method.step(lambda fraction, y: slope(y, t + fraction * h, p), state, h)
    return ca.Function("step", [state, t, h, p], [ca.cse(end)])


@lru_cache
def _cvodes(
    effects: tuple[str, ...], harmonics: int, grid: tuple[float, ...], tolerance: float, stiff: bool
) -> ca.Function:
    """Time is in lengths of the piece, so that the length is a parameter."""
    state, t, p, rhs = _symbols(effects, harmonics)
    part, length = ca.SX.sym("part"), ca.SX.sym("length")
    ode = length * ca.substitute(rhs, t, part * length)
    dae = {"x": state, "t": part, "p": ca.vertcat(length, p), "ode": ode}
    options = {"reltol": tolerance, "abstol": 0.1 * tolerance, "max_num_steps": 10_000_000}
    if not stiff:
        options |= {"linear_multistep_method": "adams", "nonlinear_solver_iteration": "functional"}
    return ca.integrator("reference", "cvodes", dae, 0.0, np.array(grid), options)


@lru_cache
def _symbols(effects: tuple[str, ...], harmonics: int) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    """State, time, parameters (coefficients of the gait, then the robot's), d(state)/dt."""
    dynamics = derive(effects)
    state = ca.SX.sym("state", len(STATE))
    v, psi, _, _, s = ca.vertsplit(state)
    size = 2 + 2 * harmonics if harmonics else 3
    t, p = ca.SX.sym("t"), ca.SX.sym("p", size + len(dynamics.parameters))
    command = _command(harmonics, t, p[:size])
    vdot, w, side, _ = dynamics.motion(v, *command, p[size:])
    rhs = ca.vertcat(
        vdot,
        w,
        v * ca.cos(psi) - side * ca.sin(psi),
        v * ca.sin(psi) + side * ca.cos(psi),
        ca.jacobian(vdot, v) * s,
    )
    return state, t, p, rhs
