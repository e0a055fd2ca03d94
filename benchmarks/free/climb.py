"""The local optimum next to a free gait, by sequential linear programs on a hand-written model.

The variables are all that a free gait is: period, offset, inertia ratio and the N accelerations;
phi and its rate are linear in them. The steady cycle is collocated with the hand-written equations
of `fourier_numpy` (order 4, four steps an interval); slopes are exact, by complex steps. Limits are
held where they are seen: phi at its own extremes, the rate at the nodes, the torque at nine places
of every interval, both sides of each jump included. Grip, energy and turns are not known here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import optimize
from scipy.sparse import csr_array

from benchmarks.optimise.bodies import body, loaded_body
from benchmarks.optimise.fourier_numpy import Array, coefficients, servo_torque, yaw_rate
from benchmarks.optimise.space import largest_posture
from rr_opt.model.gait import FreeGait
from rr_opt.model.problem import Problem

_PLACES = 9
"""Of an interval, ends included; odd, as two steps are collocated together."""
_COMPLEX = 1e-30
_FIRST, _LEAST = 0.02, 1e-7
"""Trust regions: in log T, in the offset (rad) and the ratio (relative), and as much in phi."""
_PROGRAMS, _NOTHING = 400, 1e-9
"""At most so many; and a relative gain that is none, when a program promises no more."""
_PENALTY = 10.0
"""For a row that is broken by its own size, in speeds of the start."""
_NEAR = 0.7
"""Share of a limit from which on a program knows of it."""
_BENT = 20.0
"""Largest step of an acceleration, in trust regions."""


@dataclass(frozen=True)
class Seen:
    """Of K gaits: speed (m/s) and which way, V . E, (K,); torque (K, N, places), N m."""

    speed: Array
    ahead: Array
    torque: Array


class Free:
    """A problem's free gaits of N intervals as vectors x = (log T, offset, ratio, u_1 .. u_N), u
    being d2phi/dtheta2 over (2 pi)^2, of which the mean does not count."""

    def __init__(self, problem: Problem, intervals: int):
        self.problem, self.n, n = problem, intervals, intervals
        centred = np.eye(n) - 1 / n
        slopes = np.cumsum(np.vstack([np.zeros(n), centred[:-1]]), axis=0) / n
        slopes -= slopes.mean(axis=0) + centred.mean(axis=0) / (2 * n)
        steps = slopes / n + centred / (2 * n**2)
        angles = np.cumsum(np.vstack([np.zeros(n), steps[:-1]]), axis=0)
        angles -= (angles + slopes / (2 * n) + centred / (6 * n**2)).mean(axis=0)
        scale = (2 * np.pi) ** 2
        self.bends, self.slopes, self.angles = (m * scale for m in (centred, slopes, angles))
        middle = 2j * np.pi * (np.arange(n) + 0.5) / n
        self.first = -2 / n * np.sinc(1 / n) * (np.exp(middle) @ centred)
        self.reach = largest_posture(problem)

    def vector(self, gait: FreeGait, ratio: float | None) -> Array:
        """x of a gait."""
        u = np.array(gait.accelerations) * (gait.period / (2 * np.pi)) ** 2
        return np.array([math.log(gait.period), gait.offset, ratio or 1.0, *u])

    def gait(self, x: Array) -> FreeGait:
        """Back."""
        T, u = math.exp(x[0]), x[3:]
        return FreeGait(
            T,
            float(x[1] + self.angles[0] @ u),
            float(self.slopes[0] @ u / T),
            tuple((self.bends @ u / T**2).tolist()),
        )

    def seen(self, x: Array) -> Seen:
        """Of vectors (K, 3 + N), which may be complex."""
        robot, choice = self.problem.robot, self.problem.inertia_ratio
        one, two = body(robot.platform1, robot.k1), body(robot.platform2, robot.k2)
        if choice:
            two = loaded_body(robot, choice, x[:, 2, None, None])
        T, u = np.exp(x[:, 0, None, None]), x[:, 3:].T
        s = np.linspace(0.0, 1.0, _PLACES) / self.n
        phi, slope, bend = (
            (matrix @ u).T[..., None] for matrix in (self.angles, self.slopes, self.bends)
        )
        phi = x[:, 1, None, None] + phi + s * (slope + s * bend / 2)
        q, dq = (slope + s * bend) / T, bend / T**2 + 0 * s
        a, f = coefficients(one, two, phi, q, dq)
        h = T / self.n / (_PLACES - 1)
        v, vdot = _cycle(a, f, h)
        w = yaw_rate(one, two, phi, q, v)
        torque = servo_torque(one, two, phi, q, dq, v, vdot)
        w0, wm, w1 = w[..., :-1:2], w[..., 1::2], w[..., 2::2]
        turned = np.zeros_like(w)
        rises = np.stack([h / 12 * (5 * w0 + 8 * wm - w1), h / 3 * (w0 + 4 * wm + w1)], axis=-1)
        ends = np.cumsum(rises[..., 1], axis=-1)
        starts = np.cumsum(ends[..., -1], axis=-1) - ends[..., -1]
        turned[..., 2::2] = ends
        turned[..., 1::2] = np.concatenate([0 * ends[..., :1], ends[..., :-1]], -1) + rises[..., 0]
        turned += starts[..., None]
        theta = (np.arange(self.n)[:, None] + s * self.n) / self.n
        chi = turned - theta * (starts[:, -1] + ends[:, -1, -1])[:, None, None]
        weights = np.array([1.0, *[4.0, 2.0] * (_PLACES // 2)]) / (3 * (_PLACES - 1) * self.n)
        weights[-1] = weights[0]
        cos, sin, side = np.cos(chi), np.sin(chi), -one.c * w
        V = [(part @ weights).sum(axis=1) for part in (cos * v - sin * side, sin * v + cos * side)]
        E = [(part @ weights).sum(axis=1) for part in (cos, sin)]
        return Seen(np.sqrt(V[0] ** 2 + V[1] ** 2), V[0] * E[0] + V[1] * E[1], torque)

    def linear(self, x: Array) -> tuple[Array, Array]:
        """Rows that are linear but for the period: shares of their limits, which must not exceed 1,
        and slopes in x."""
        n, limits = self.n, self.problem.limits
        slope, bend = self.slopes @ x[3:], self.bends @ x[3:]
        at = np.clip(-slope / np.where(bend == 0, np.inf, bend), 0.0, 1 / n)[:, None]
        to_u = self.angles + at * (self.slopes + at * self.bends / 2)
        swing = to_u @ x[3:]
        none, ones = np.zeros((n, 1)), np.ones((n, 1))
        swing_to = np.hstack([none, none, none, to_u])
        angle_to = np.hstack([none, ones, none, to_u])
        most = self.problem.gait.amplitude.high
        rows = [
            (swing / most, swing_to / most),
            ((x[1] + swing) / self.reach, angle_to / self.reach),
        ]
        if math.isfinite(limits.rate):
            size = math.exp(x[0]) * limits.rate
            rate_to = np.hstack([-slope[:, None], none, none, self.slopes]) / size
            rows.append((slope / size, rate_to))
        values = np.concatenate([row for row, _ in rows])
        slopes = np.concatenate([to for _, to in rows])
        return np.concatenate([values, -values]), np.concatenate([slopes, -slopes])

    def harmonic(self, x: Array) -> tuple[float, Array]:
        """The first harmonic, rad, and its slope in x."""
        first = self.first @ x[3:]
        return abs(first), np.array([0, 0, 0, *(first.conjugate() * self.first).real / abs(first)])


def _cycle(a: Array, f: Array, h: Array) -> tuple[Array, Array]:
    """v and vdot (K, N, places) of vdot = a v + f, periodic, in steps of 2 h by Hermite-Simpson."""
    H = 2 * h
    (a0, am, a1), (f0, fm, f1) = (
        (part[..., :-1:2], part[..., 1::2], part[..., 2::2]) for part in (a, f)
    )
    inner = 4 * H / 6 * am
    divisor = 1 - H / 6 * a1 - inner * (0.5 - H / 8 * a1)
    gain = (1 + H / 6 * a0 + inner * (0.5 + H / 8 * a0)) / divisor
    shift = (H / 6 * (f0 + f1 + 4 * fm) + inner * H / 8 * (f0 - f1)) / divisor
    K = len(gain)
    gains, shifts = gain.reshape(K, -1), shift.reshape(K, -1)
    whole, offset = np.ones_like(gains[:, 0]), np.zeros_like(gains[:, 0])
    for k in range(gains.shape[1]):
        whole, offset = gains[:, k] * whole, gains[:, k] * offset + shifts[:, k]
    now = offset / (1 - whole)
    starts = np.empty_like(gains)
    for k in range(gains.shape[1]):
        starts[:, k] = now
        now = gains[:, k] * now + shifts[:, k]
    v0 = starts.reshape(gain.shape)
    v1 = gain * v0 + shift
    d0, d1 = a0 * v0 + f0, a1 * v1 + f1
    v = np.empty_like(a)
    v[..., :-1:2], v[..., 2::2] = v0, v1
    v[..., 1::2] = (v0 + v1) / 2 + H / 8 * (d0 - d1)
    return v, a * v + f


@dataclass(frozen=True)
class Climbed:
    """Where a climb ended: the gait, its speed (m/s, >= 0), by how much the worst limit is broken,
    relative, and after how many linear programs."""

    gait: FreeGait
    ratio: float | None
    speed: float
    excess: float
    programs: int


def climb(problem: Problem, gait: FreeGait, ratio: float | None) -> Climbed:
    """Climb from a gait; what it breaks a limit by, by a hair, stays allowed."""
    free = Free(problem, gait.pieces)
    x = free.vector(gait, ratio)
    start, excess = _worst(free, x)
    allowed, reach, programs = max(excess, 0.0), _FIRST, 0
    here = _rows(free, x, allowed)
    while reach > _LEAST and programs < _PROGRAMS:
        programs += 1
        step, slack = _step(free, x, here, start, reach)
        promised = here.slope @ step / start - _PENALTY * (slack - here.broken)
        if promised < _NOTHING:
            break
        there = _rows(free, x + step, allowed)
        gained = (there.speed - here.speed) / start - _PENALTY * (there.broken - here.broken)
        if gained < 0.1 * promised:
            reach /= 3
            continue
        x, here = x + step, there
        if gained > 0.7 * promised:
            reach = min(2 * reach, 0.1)
    speed, excess = _worst(free, x)
    return Climbed(free.gait(x), float(x[2]) if ratio else None, speed, excess, programs)


def _worst(free: Free, x: Array) -> tuple[float, float]:
    """Speed, and by how much the worst limit is broken, relative; endless the wrong way."""
    found, (rows, _), problem = free.seen(x[None]), free.linear(x), free.problem
    way = {"forward": 1, "backward": -1, "either": 0}[problem.direction]
    if way * found.ahead[0] < 0:
        return float(found.speed[0]), math.inf
    least = problem.gait.amplitude.low / max(free.harmonic(x)[0], 1e-12)
    worst = max(rows.max(), np.abs(found.torque).max() / problem.limits.torque, least)
    return float(found.speed[0]), float(worst - 1)


@dataclass(frozen=True)
class _Rows:
    """Speed and its slope; rows that must not be positive, and theirs."""

    speed: float
    slope: Array
    values: Array
    to: Array

    @property
    def broken(self) -> float:
        """By how much, all rows together."""
        return float(np.maximum(self.values, 0).sum())


def _rows(free: Free, x: Array, allowed: float) -> _Rows:
    d, problem = len(x), free.problem
    around = np.tile(x.astype(complex), (d + 1, 1))
    around[np.arange(d), np.arange(d)] += 1j * _COMPLEX
    found = free.seen(around)
    torque = found.torque.reshape(d + 1, -1) / problem.limits.torque
    share, share_to = torque[-1].real, torque[:-1].imag.T / _COMPLEX
    rows, to = free.linear(x)
    first, first_to = free.harmonic(x)
    least = problem.gait.amplitude.low
    values = np.concatenate([rows - 1, share - 1, -share - 1]) - allowed
    return _Rows(
        float(found.speed[-1].real),
        found.speed[:-1].imag / _COMPLEX,
        np.append(values, 1 - first / least),
        np.vstack([to, share_to, -share_to, -first_to / least]),
    )


def _step(free: Free, x: Array, here: _Rows, unit: float, reach: float) -> tuple[Array, float]:
    """The step of a linear program within the trust region, and how much of all rows it leaves
    broken: each has a slack. The region counts in dphi/dtheta at the nodes."""
    n, d, box, choice = free.n, len(x), free.problem.gait, free.problem.inertia_ratio
    near = here.values > _NEAR - 1
    rows, to, m = here.values[near], here.to[near], int(near.sum())
    whole = choice and choice.by == "loads" and choice.loads.whole
    ratio = (x[2], x[2]) if whole or not choice else (choice.bounds.low, choice.bounds.high)
    ranges = [
        (math.log(box.period.low), math.log(box.period.high)),
        (box.offset.low, box.offset.high),
        ratio,
    ]
    bounds = [
        (min(max(low - at, -reach), 0.0), max(min(high - at, reach), 0.0))
        for (low, high), at in zip(ranges, x[:3], strict=True)
    ]
    slopes = np.hstack([np.zeros((n, 3)), free.slopes / (2 * np.pi), np.zeros((n, m))])
    limited = np.vstack([np.hstack([to, -np.eye(m)]), slopes, -slopes])
    level = np.concatenate([np.zeros(3), np.ones(n), np.zeros(m)])[None]
    found = optimize.linprog(
        np.concatenate([-here.slope / unit, np.full(m, _PENALTY)]),
        A_ub=csr_array(limited),
        b_ub=np.concatenate([-rows, np.full(2 * n, reach)]),
        A_eq=csr_array(level),
        b_eq=[-x[3:].sum()],
        bounds=[*bounds, *[(-_BENT * reach, _BENT * reach)] * n, *[(0, None)] * m],
        method="highs",
    )
    if found.status:
        raise ValueError(found.message)
    return found.x[:d], float(found.x[d:].sum())
