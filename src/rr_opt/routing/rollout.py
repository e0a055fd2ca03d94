"""The motion that a command makes from rest, and its derivatives by everything in the command.

Within a segment the motion is integrated in the frame of its start, together with its derivatives S
by the speed at the start and by the eight numbers u of the segment: with z = (v, phi, dphi, ddphi)
and f the rates of (v, psi, x, y), multiplied by the duration,

    dS/ds = f_y S + f_z z_u,        z_u from the formula of the command

whose Jacobians are small. Segments are then chained: each depends on those before it through v,
the phase and its frame alone.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.mechanics.compile_cache import externals
from rr_opt.mechanics.runge_kutta import BUTCHER6
from rr_opt.model.command import Command, blended
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import derive, dynamics_of

STEPS = 12
"""Steps of order 6 in a period: a drive of 100 periods ends within some 10 um of the truth."""
_INPUTS = 9
"""v at the start of a segment, and the eight numbers of the segment."""


@lru_cache
def _step(effects: tuple[str, ...]) -> ca.Function:
    """(state, s, h, u, p) -> state after a step of length h. The state holds (v, psi, x, y), S by
    columns, and the torque at its end with its derivatives."""
    dynamics = derive(effects)
    y, S = ca.SX.sym("y", 4), ca.SX.sym("S", 4, _INPUTS)
    u, p = ca.SX.sym("u", 8), ca.SX.sym("p", len(dynamics.parameters))
    s, h = ca.SX.sym("s"), ca.SX.sym("h")
    z = ca.SX.sym("z", 4)
    vdot, w, side, torque = dynamics.motion(z[0], z[1], z[2], z[3], p)
    cos, sin = ca.cos(y[1]), ca.sin(y[1])
    rates = u[7] * ca.vertcat(vdot, w, z[0] * cos - side * sin, z[0] * sin + side * cos)
    command = ca.vertcat(*blended(s, ca.vertsplit(u), ca.sin, ca.cos))
    z_u = ca.horzcat(ca.SX(3, 1), ca.jacobian(command, u))
    of_u = ca.horzcat(ca.SX(4, 1), ca.jacobian(rates, u))
    z_all = ca.vertcat(S[0, :], z_u)
    slopes = ca.jacobian(rates, z) @ z_all + ca.jacobian(rates, y[1]) @ S[1, :] + of_u
    torques = ca.horzcat(torque, ca.jacobian(torque, z) @ z_all)
    inputs = [y, S, s, z, u, p]
    field = ca.Function("field", inputs, [ca.horzcat(rates, slopes)])
    effort = ca.Function("effort", inputs, [torques])

    def at(fraction, state):
        now = s + fraction * h
        return now, ca.vertcat(state[0, 0], *blended(now, ca.vertsplit(u), ca.sin, ca.cos))

    def slope(fraction, state):
        now, inside = at(fraction, state)
        return field(state[:, 0], state[:, 1:], now, inside, u, p)

    state = ca.SX.sym("state", 4, 1 + _INPUTS)
    end = BUTCHER6.step(slope, state, h)
    now, inside = at(1.0, end)
    seen = effort(end[:, 0], end[:, 1:], now, inside, u, p)
    carried = ca.SX.sym("carried", 5 * (1 + _INPUTS))
    whole = ca.vec(ca.vertcat(end, seen))
    before = ca.reshape(carried, 5, 1 + _INPUTS)[:4, :]
    whole = ca.substitute(whole, ca.vec(state), ca.vec(before))
    return ca.Function("step", [carried, s, h, u, p], [ca.cse(whole)])


@lru_cache
def _compiled(effects: tuple[str, ...]) -> ca.Function:
    """The step as machine code, if there is a compiler."""
    made = externals("route", (_step(effects),), ("-O1", "-fPIC", "-shared"), make=True)
    return made[0] if made else _step(effects)


@lru_cache(maxsize=512)
def _steps(effects: tuple[str, ...], count: int) -> ca.Function:
    return _compiled(effects).mapaccum(count)


@dataclass(frozen=True)
class Samples:
    """The motion at the end of every step: t (n,), segment (n,) to which it belongs, path (5, n)
    with v (m/s), psi (rad), x, y (m), torque (N m), and its derivatives (5, n, z)."""

    segment: Array
    t: Array
    path: Array
    slopes: Array


def stepped(effects: tuple[str, ...], p: Array, v: float, u: Array, grid: Array) -> Array:
    """(1 + 9, 5, n): v (m/s), psi (rad), x, y (m) and torque (N m) of a segment u from the speed v,
    in the frame of its start; then their derivatives by v and u. grid (n + 1,): parts of the
    duration, the first of them 0. p: values of the robot's parameters."""
    start = np.zeros((5, 1 + _INPUTS))
    start[0, :2] = v, 1.0
    n = len(grid) - 1
    parts = grid[None, :-1], np.diff(grid)[None], np.tile(u[:, None], n), np.tile(p[:, None], n)
    out = _steps(effects, n)(start.ravel("F"), *parts)
    return np.asarray(out).reshape(1 + _INPUTS, 5, n)


def rollout(
    robot: Robot,
    command: Command,
    slopes: Array,
    steps: Sequence[int],
    pose: tuple[float, float, float],
) -> Samples:
    """Drive a command from rest at the pose x (m), y (m), psi (rad).

    slopes  (8, N, z): derivatives of `command.segments` by the unknowns
    steps   of each segment
    """
    dynamics = dynamics_of(robot)
    p = dynamics.values(robot)
    unknowns = slopes.shape[2]
    v, dv = 0.0, np.zeros(unknowns)
    x, y, psi = pose
    dx, dy, dpsi = (np.zeros(unknowns) for _ in range(3))
    found, at = [], 0.0
    for k, (u, n) in enumerate(zip(command.segments.T, steps, strict=True)):
        grid = np.arange(n + 1) / n
        out = stepped(dynamics.effects, p, v, u, grid)
        local, S = out[0], out[1:]
        inputs = np.vstack([dv, slopes[:, k]])
        d = np.einsum("isn,iz->snz", S, inputs)
        cos, sin = math.cos(psi), math.sin(psi)
        path, dpath = local.copy(), d.copy()
        path[1] += psi
        dpath[1] += dpsi
        path[2] = x + cos * local[2] - sin * local[3]
        path[3] = y + sin * local[2] + cos * local[3]
        dpath[2] = dx + cos * d[2] - sin * d[3] - np.outer(path[3] - y, dpsi)
        dpath[3] = dy + sin * d[2] + cos * d[3] + np.outer(path[2] - x, dpsi)
        found.append((np.full(n, k), at + u[7] * grid[1:], path, dpath))
        at += u[7]
        v, psi, x, y = path[:4, -1]
        dv, dpsi, dx, dy = dpath[:4, -1]
    segment, t, path, dpath = zip(*found, strict=True)
    return Samples(
        np.concatenate(segment), np.concatenate(t), np.hstack(path), np.concatenate(dpath, axis=1)
    )


def steps_for(command: Command) -> list[int]:
    """How many steps each segment takes."""
    turned = command.durations * (command.knots[2, :-1] + command.knots[2, 1:]) / (4 * math.pi)
    return [max(6, math.ceil(STEPS * periods)) for periods in turned]
