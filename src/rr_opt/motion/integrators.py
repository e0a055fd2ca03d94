"""The equation of motion of a gait as CasADi integrators: fixed steps, and cvodes.

Both carry the state (v, psi, x, y, s) with s = dv/dv(0) the sensitivity that closes a cycle.
cvodes at tight tolerance is the reference that everything else is held against. Neither steps
across a jump of the servo's acceleration: both begin anew at each piece of the gait.
"""

from __future__ import annotations

import math
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.mechanics.runge_kutta import BUTCHER6, Tableau
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.command import Form, form_of, numbers_of
from rr_opt.motion.dynamics import derive, dynamics_of

STATE = ("v", "psi", "x", "y", "s")

_SNAP = 1e-9
"""A time so near to the end of a piece, relative to the piece, is that end."""

_CVODES = {"reltol": 1e-12, "abstol": 1e-13, "max_num_steps": 10_000_000}


def whole_steps(gait: Gait, steps: int) -> int:
    """The least number of equal steps a period, `steps` or more, whose ends meet all jumps."""
    return gait.pieces * math.ceil(steps / gait.pieces)


def fixed_steps(
    robot: Robot, gait: Gait, v0: float, *, steps: int, method: Tableau = BUTCHER6
) -> Array:
    """States (5, n + 1) over one period from v(0) = v0, at n = whole_steps(gait, steps)."""
    dynamics = dynamics_of(robot)
    n = whole_steps(gait, steps)
    each, h = n // gait.pieces, gait.period / n
    path = _path(dynamics.effects, form_of(gait), method, n)
    since = np.tile(np.arange(each) * h, gait.pieces)
    numbers = np.repeat(numbers_of(gait), each, axis=1)
    inputs = np.vstack([numbers, np.tile(dynamics.values(robot)[:, None], n)])
    out = path(_start(v0), since[None], np.full((1, n), h), inputs)
    return np.column_stack([_start(v0), np.asarray(out)])


def cvodes(robot: Robot, gait: Gait, v0: float, times: ArrayLike) -> Array:
    """States (5, len(times)) at `times` (s, increasing from 0) by CVODES at 1e-12, relative."""
    times = np.asarray(times, float)
    dynamics, numbers = dynamics_of(robot), numbers_of(gait)
    values = dynamics.values(robot)
    length = gait.period / gait.pieces if gait.pieces > 1 else float(times[-1])
    at = times[1:] / length
    at = np.where(np.abs(at - np.round(at)) < _SNAP, np.round(at), at)
    piece = np.ceil(at).astype(int) - 1
    states, state = [_start(v0)[:, None]], _start(v0)
    for k in range(piece[-1] + 1):
        inside = slice(*np.searchsorted(piece, [k, k + 1]))
        # Rounded, as pieces that are cut alike then share an integrator.
        grid = tuple(np.round(at[inside] - k, 12))
        grid += () if grid and grid[-1] == 1.0 else (1.0,)
        run = _cvodes(dynamics.effects, form_of(gait), grid)
        p = np.concatenate([[length], numbers[:, k % gait.pieces], values])
        out = np.asarray(run(x0=state, p=p)["xf"])
        states.append(out[:, : inside.stop - inside.start])
        state = out[:, -1]
    return np.hstack(states)


def _start(v0: float) -> Array:
    return np.array([v0, 0.0, 0.0, 0.0, 1.0])


@lru_cache
def _path(effects: tuple[str, ...], form: Form, method: Tableau, steps: int) -> ca.Function:
    return _stepper(effects, form, method).mapaccum(steps)


@lru_cache
def _stepper(effects: tuple[str, ...], form: Form, method: Tableau) -> ca.Function:
    state, t, p, rhs = _symbols(effects, form)
    slope = ca.Function("slope", [state, t, p], [rhs])
    h = ca.SX.sym("h")
    end = method.step(lambda fraction, y: slope(y, t + fraction * h, p), state, h)
    return ca.Function("step", [state, t, h, p], [ca.cse(end)])


@lru_cache
def _cvodes(effects: tuple[str, ...], form: Form, grid: tuple[float, ...]) -> ca.Function:
    """Time is counted in lengths of the piece, so that its length need not be known here."""
    state, t, p, rhs = _symbols(effects, form)
    part, length = ca.SX.sym("part"), ca.SX.sym("length")
    ode = length * ca.substitute(rhs, t, part * length)
    dae = {"x": state, "t": part, "p": ca.vertcat(length, p), "ode": ode}
    return ca.integrator("reference", "cvodes", dae, 0.0, np.array(grid), _CVODES)


@lru_cache
def _symbols(effects: tuple[str, ...], form: Form) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    dynamics = derive(effects)
    state = ca.SX.sym("state", len(STATE))
    v, psi, _, _, s = ca.vertsplit(state)
    t, p = ca.SX.sym("t"), ca.SX.sym("p", form.size + len(dynamics.parameters))
    command = form.command(t, p[: form.size])
    vdot, w, side, _ = dynamics.motion(v, *command, p[form.size :])
    rhs = ca.vertcat(
        vdot,
        w,
        v * ca.cos(psi) - side * ca.sin(psi),
        v * ca.sin(psi) + side * ca.cos(psi),
        ca.jacobian(vdot, v) * s,
    )
    return state, t, p, rhs
