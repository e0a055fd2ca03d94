"""The motion of a command from rest, and its derivatives by everything in the command.

Within a segment the motion is integrated in the frame of its start, together with its sensitivities
S to the initial speed and to the eight numbers u of the segment: with z = (v, phi, dphi, ddphi)
and f the rates of (v, psi, x, y), multiplied by the duration,

    dS/ds = f_y S + f_z z_u,        z_u from the formula of the command

whose Jacobians are small. Segments are then chained: each depends on those before it only through
v, the phase and its frame.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.mechanics.compile_cache import externals
from rr_opt.mechanics.runge_kutta import BUTCHER6
from rr_opt.model.command import Command, blended
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import derive, dynamics_of

STEPS = 16
"""Steps of order 6 per period: the end of a drive of 100 periods is accurate to some 10 um."""
_INPUTS = 9
"""v at the start of a segment, and the eight numbers of the segment."""
LOADS = ("torque", "grip", "grip")
"""Loads on the robot: the torque, N m, and the side force of each axle over the load on it."""
_FINER, _PARTS = 4, 4
"""Parts of a step in which loads are evaluated, and parts of a segment, in each of which the
largest of either sign is found."""
_STENCILS = np.array(
    [[1, -8, 0, 8, -1], [-1, 16, -30, 16, -1], [-6, 12, 0, -12, 6], [12, -48, 72, -48, 12]]
).T / 12  # fmt: skip
_NEWTON = 3
"""Derivatives from five samples at unit spacing; and Newton steps."""


@lru_cache
def _functions(effects: tuple[str, ...]) -> tuple[ca.Function, ...]:
    """Of (.., s, h, u, p), with a step from s to s + h of a segment:

    step   state -> the next: (v, psi, x, y), and S, by columns
    scan   v at both ends -> loads at `_FINER` + 1 places, v by a cubic
    loads  state -> loads at s, and their derivatives by v and u at the segment's start
    """
    dynamics = derive(effects)
    y, S = ca.SX.sym("y", 4), ca.SX.sym("S", 4, _INPUTS)
    u, p = ca.SX.sym("u", 8), ca.SX.sym("p", len(dynamics.parameters))
    s, h = ca.SX.sym("s"), ca.SX.sym("h")
    z = ca.SX.sym("z", 4)
    vdot, w, side, torque = dynamics.motion(z[0], z[1], z[2], z[3], p)
    grips = dynamics.grip(z[0], z[1], z[2], z[3], p)
    cos, sin = ca.cos(y[1]), ca.sin(y[1])
    rates = u[7] * ca.vertcat(vdot, w, z[0] * cos - side * sin, z[0] * sin + side * cos)
    command = ca.vertcat(*blended(s, ca.vertsplit(u), ca.sin, ca.cos))
    z_u = ca.horzcat(ca.SX(3, 1), ca.jacobian(command, u))
    of_u = ca.horzcat(ca.SX(4, 1), ca.jacobian(rates, u))
    z_all = ca.vertcat(S[0, :], z_u)
    slopes = ca.jacobian(rates, z) @ z_all + ca.jacobian(rates, y[1]) @ S[1, :] + of_u
    load = ca.vertcat(torque, *grips)
    inputs = [y, S, s, z, u, p]
    field = ca.Function("field", inputs, [ca.horzcat(rates, slopes)])
    effort = ca.Function("effort", inputs, [ca.horzcat(load, ca.jacobian(load, z) @ z_all)])
    acceleration = ca.Function("acceleration", [z, p], [vdot])
    plain = ca.Function("plain", [z, p], [load])

    def inside(place, v):
        return ca.vertcat(v, *blended(place, ca.vertsplit(u), ca.sin, ca.cos))

    def slope(fraction, state):
        now = s + fraction * h
        return field(state[:, 0], state[:, 1:], now, inside(now, state[0, 0]), u, p)

    state = ca.SX.sym("state", 4, 1 + _INPUTS)
    end = BUTCHER6.step(slope, state, h)
    there = effort(state[:, 0], state[:, 1:], s, inside(s, state[0, 0]), u, p)
    v = ca.SX.sym("v", 2)
    first, last = (h * u[7] * acceleration(inside(s + k * h, v[k]), p) for k in (0, 1))
    seen = []
    for k in range(_FINER + 1):
        part = k / _FINER
        cubic = v[0] + part * part * (3 - 2 * part) * (v[1] - v[0])
        cubic += part * (1 - part) * ((1 - part) * first - part * last)
        seen.append(plain(inside(s + part * h, cubic), p))
    made = {"step": (ca.vec(state), ca.vec(end)), "scan": (v, ca.horzcat(*seen)),
            "loads": (ca.vec(state), there)}  # fmt: skip
    return tuple(
        ca.Function(name, [before, s, h, u, p], [ca.cse(after)])
        for name, (before, after) in made.items()
    )


@lru_cache
def _compiled(effects: tuple[str, ...]) -> tuple[ca.Function, ...]:
    """The functions as machine code, if a compiler is available."""
    functions = _functions(effects)
    flags = ("-O1", "-fPIC", "-shared")
    return externals("route", functions, flags, make=True) or functions


class _OnArrays:
    """A CasADi function over arrays, called through buffers, as conversion takes longer than most
    calls. Its arguments are broadcast as needed."""

    def __init__(self, function: ca.Function):
        self._buffer, self._trigger = function.buffer()
        self._inputs = [np.zeros(function.size_in(k), order="F") for k in range(function.n_in())]
        self._out = np.zeros(function.size_out(0), order="F")
        for k, own in enumerate(self._inputs):
            self._buffer.set_arg(k, own.T.data)  # pyright: ignore[reportCallIssue] - it takes a buffer
        self._buffer.set_res(0, self._out.T.data)  # pyright: ignore[reportCallIssue]

    def __call__(self, *given: Array) -> Array:
        for own, one in zip(self._inputs, given, strict=True):
            own[:] = one
        self._trigger()
        return self._out.copy()


@lru_cache(maxsize=512)
def _steps(effects: tuple[str, ...], count: int) -> _OnArrays:
    return _OnArrays(_compiled(effects)[0].mapaccum(count))


@lru_cache(maxsize=64)
def _mapped(effects: tuple[str, ...], which: int, count: int) -> _OnArrays:
    return _OnArrays(_compiled(effects)[which].map(count))


@dataclass(frozen=True)
class Samples:
    """The motion at the end of every step: t (n,), the step's segment (n,), path (4, n) with v
    (m/s), psi (rad), x, y (m), and its derivatives (4, n, z).

    peaks  of the requested loads, in every part of a segment the largest, and minus the least:
           (loads, segments, parts, 2), and its derivatives (.., z)
    """

    segment: Array
    t: Array
    path: Array
    slopes: Array
    peaks: Array
    peak_slopes: Array


def stepped(effects: tuple[str, ...], p: Array, v: float, u: Array, grid: Array) -> Array:
    """(1 + 9, 4, n): v (m/s), psi (rad), x, y (m) of a segment u from the speed v, in the frame of
    its start; then their derivatives by v and u. grid (n + 1,): parts of the duration, the first
    of them 0. p: values of the robot's parameters."""
    n = len(grid) - 1
    state = _from(v).reshape(-1, 1)
    out = _steps(effects, n)(state, grid[:-1], np.diff(grid), u[:, None], p[:, None])
    return out.reshape(1 + _INPUTS, 4, n)


def _from(v: float) -> Array:
    """The state at the start of a segment, (1 + 9, 4)."""
    start = np.zeros((1 + _INPUTS, 4))
    start[:2, 0] = v, 1.0
    return start


def _peaks(
    effects: tuple[str, ...], p: Array, segments: Array, states: list[Array], loads: Sequence[int]
) -> tuple[Array, Array]:
    """The peaks of loads in segments (8, N): values (loads, N, parts, 2), derivatives (9, ..) by
    the speed and the segment. states: (1 + 9, 4, n + 1) at the ends of each segment's steps.

    A peak is located by Newton's method on a quartic through finer samples. The load is stationary
    there, so derivatives at a fixed place are those of the peak.
    """
    counts = np.array([state.shape[2] - 1 for state in states])
    of = np.repeat(np.arange(len(counts)), counts)
    begin = np.concatenate([np.arange(n) / n for n in counts])
    v = np.hstack([np.stack([state[0, 0, :-1], state[0, 0, 1:]]) for state in states])
    step = 1 / counts[of]
    seen = _mapped(effects, 1, len(of))(v, begin, step, segments[:, of], p[:, None])
    seen = seen.reshape(len(LOADS), len(of), -1)[list(loads)]
    last = np.cumsum(counts) - 1
    # The places of every segment, both ends included, in sequence.
    fine = np.insert(
        seen[:, :, :-1].reshape(len(loads), -1), (last + 1) * _FINER, seen[:, last, -1], axis=1
    )
    signed = np.stack([fine, -fine], axis=1)
    sizes = counts * _FINER + 1
    ends = np.cumsum(sizes)
    begins = ends - sizes
    edges = begins[:, None] + sizes[:, None] * np.arange(_PARTS + 1) // _PARTS
    parts = [part for row in edges for part in itertools.pairwise(row)]
    at = np.stack([low + signed[:, :, low:high].argmax(axis=2) for low, high in parts], axis=2)
    k = np.repeat(np.arange(len(counts)), _PARTS)
    middle = np.clip(at, begins[k] + 2, ends[k] - 3)
    near = (middle[..., None] + np.arange(-2, 3)).reshape(*signed.shape[:2], -1)
    near = np.take_along_axis(signed, near, 2).reshape(*at.shape, 5)
    slope, bend, third, fourth = np.moveaxis(near @ _STENCILS, -1, 0)
    moved = (at - middle).astype(float)
    for _ in range(_NEWTON):
        up = slope + moved * (bend + moved * (third / 2 + moved * fourth / 6))
        curved = bend + moved * (third + moved * fourth / 2)
        moved = moved - up / np.where(curved < 0, curved, np.inf)
    away = moved + middle - at
    inside = (np.abs(away) < 1) & (at > begins[k]) & (at < ends[k] - 1)
    place = (at + np.where(inside, away, 0.0) - begins[k]) / (sizes[k] - 1)

    k, place = np.broadcast_to(k, place.shape).ravel(), place.ravel()
    n = counts[k]
    before = np.minimum((place * n).astype(int), n - 1)
    state = np.concatenate(states, axis=2)[:, :, last[k] + 1 - n + k + before]
    rest = segments[:, k], p[:, None]
    state = state.reshape(4 + 4 * _INPUTS, -1)
    state = _mapped(effects, 0, len(k))(state, before / n, place - before / n, *rest)
    found = _mapped(effects, 2, len(k))(state, place, np.zeros(1), *rest)
    found = found.reshape(len(LOADS), len(k), 1 + _INPUTS)
    which = np.repeat(loads, len(k) // len(loads))
    found = found[which, np.arange(len(k))].T.reshape(1 + _INPUTS, len(loads), 2, len(counts), -1)
    found = np.moveaxis(found, 2, -1) * [1.0, -1.0]
    return found[0], found[1:]


def rollout(
    robot: Robot,
    command: Command,
    slopes: Array,
    steps: Sequence[int],
    pose: tuple[float, float, float],
    *,
    loads: Sequence[int] = (),
    starts: Mapping[int, Array] = MappingProxyType({}),
) -> Samples:
    """Drive a command from rest at the pose x (m), y (m), psi (rad).

    slopes  (8, N, z): derivatives of `command.segments` by the unknowns
    steps   of each segment
    loads   indices into LOADS, whose peaks are wanted
    starts  v, psi, x, y with which segments restart. The last unknown then closes the gaps: at 1
            to first order.
    """
    dynamics = dynamics_of(robot)
    p = dynamics.values(robot)
    unknowns = slopes.shape[2]
    v, dv = 0.0, np.zeros(unknowns)
    x, y, psi = pose
    dx, dy, dpsi = (np.zeros(unknowns) for _ in range(3))
    found, at = [], 0.0
    states, all_inputs = list[Array](), list[Array]()
    for k, (u, n) in enumerate(zip(command.segments.T, steps, strict=True)):
        if k in starts:
            for one, gap in zip((dv, dpsi, dx, dy), (v, psi, x, y) - starts[k], strict=True):
                one[-1] += gap
            v, psi, x, y = starts[k]
        grid = np.arange(n + 1) / n
        out = stepped(dynamics.effects, p, v, u, grid)
        states.append(np.concatenate([_from(v)[:, :, None], out], axis=2))
        local, S = out[0], out[1:]
        inputs = np.vstack([dv, slopes[:, k]])
        all_inputs.append(inputs)
        d = np.tensordot(S, inputs, (0, 0))
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
        dv, dpsi, dx, dy = dpath[:4, -1].copy()
    segment, t, path, dpath = zip(*found, strict=True)
    none = 0, len(states), _PARTS, 2
    peaks, by = np.zeros(none), np.zeros((*none, unknowns))
    if loads:
        peaks, by = _peaks(dynamics.effects, p, command.segments, states, loads)
        by = np.einsum("ilkms,kiz->lkmsz", by, np.array(all_inputs), optimize=True)
    motion = np.hstack(path), np.concatenate(dpath, axis=1)
    return Samples(np.concatenate(segment), np.concatenate(t), *motion, peaks, by)


def steps_for(command: Command) -> list[int]:
    """How many steps each segment takes."""
    turned = command.durations * (command.knots[2, :-1] + command.knots[2, 1:]) / (4 * math.pi)
    return [max(6, math.ceil(STEPS * periods)) for periods in turned]
