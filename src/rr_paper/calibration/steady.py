"""Mean speeds of straight steady cycles, thousands of robots at once.

The derived equation of motion as coefficients that know the posture alone, over arrays.

With q = dphi and r = ddphi viscous friction gives

    vdot = (a_vq q + a_v) v + a_qq q^2 + a_q q + a_r r,     w = w_v v + w_q q

and wheel i rolls at u_i = p_i v + s_i q. A force -F(u_i) at each wheel adds
-sum F(u_i) p_i/inertia to vdot. `rr_opt.verify.speed_powers` has the first of these too, and the
torque, which costs five times as much as all that is needed here.

The angle that the servo makes of a commanded sine, in steady motion.

exact       the command
lagging     a first-order lag: smaller by sqrt(1 + (tau omega)^2), and later, which does not
            change a mean speed
limited     dphi/dt = R tanh((command - phi)/(R tau)): it closes in on the command like a lag of
            tau, but no faster than R. Told to go faster it runs at R all the time, and the angle
            becomes a triangle of amplitude R T/4, whatever was commanded.

A straight gait is its own mirror image half a period later, so half a period says everything
and v repeats after it. With viscous friction v is the periodic solution of a linear equation.
With dry friction it is stepped through half a period, and the speed at its start is moved by
Newton's method inside a bracket until the end meets it.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.effects.coulomb_friction import SMOOTHING_SPEED
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS, mechanism
from rr_opt.mechanics.vectorised import ArrayFunction, over_arrays
from rr_opt.motion.dynamics import derive
from rr_opt.verify.fourier import integral, solve
from rr_paper.publication import TABLE_1


class Linear(NamedTuple):
    """vdot = slope v + drive and w = turn_v v + turn_q q along a gait, (n, G) each, SI."""

    slope: Array
    drive: Array
    turn_v: Array
    turn_q: Array


class Wheels(NamedTuple):
    """p_i and s_i q of the four wheels, (4, n, G) each, and the inertia seen by v, (n, G), kg."""

    along_v: Array
    carried: Array
    inertia: Array


def linear(phi: Array, q: Array, r: Array, p: Array) -> Linear:
    """phi (rad), q (rad/s), r (rad/s2) at n samples of G gaits (n, G); p (13, G)."""
    a_vq, a_v, a_qq, a_q, a_r, w_v, w_q = _functions()[0](phi, *p)
    return Linear(a_vq * q + a_v, (a_qq * q + a_q) * q + a_r * r, w_v, w_q)


def wheels(phi: Array, q: Array, p: Array) -> Wheels:
    """The same for what the wheels do."""
    *rolling, inertia = (np.broadcast_to(part, phi.shape) for part in _functions()[1](phi, *p))
    return Wheels(np.array(rolling[:4]), np.array(rolling[4:]) * q, inertia)


@lru_cache
def _functions() -> tuple[ArrayFunction, ArrayFunction]:
    dynamics, robot = derive(()), mechanism()
    phi, p = ca.SX.sym("phi"), ca.SX.sym("p", len(ROBOT_PARAMETERS))
    v, q, r = (ca.SX.sym(name) for name in "vqr")
    vdot, w, _, _ = dynamics.motion(v, phi, q, r, p)
    bend = ca.hessian(vdot, ca.vertcat(v, q))[0]
    inertia = ca.hessian(dynamics.energy(v, phi, q, p)[0], v)[0]
    here = ca.vertcat(robot.phi, robot.speeds, *(robot.parameters[n] for n in ROBOT_PARAMETERS))
    speeds = [
        ca.substitute(robot.rolling_speed(wheel), here, ca.vertcat(phi, v, 0, 0, q, p))
        for wheel in robot.wheels
    ]

    def coefficients(name: str, *parts: ca.SX) -> ArrayFunction:
        at_rest = ca.substitute(ca.vertcat(*parts), ca.vertcat(v, q, r), ca.SX.zeros(3))
        return over_arrays(ca.Function(name, [phi, p], ca.vertsplit(ca.cse(at_rest))))

    slopes = (ca.jacobian(vdot, x) for x in (v, q, r))
    a_v, a_q, a_r = slopes
    turning = (ca.jacobian(w, x) for x in (v, q))
    rolling = (ca.jacobian(u, x) for x in (v, q) for u in speeds)
    return (
        coefficients("linear", bend[0, 1], a_v, bend[1, 1] / 2, a_q, a_r, *turning),
        coefficients("wheels", *rolling, inertia),
    )


RATE_LIMIT = TABLE_1["greatest rate dphi/dt"].value * math.pi / 30
"""Table 1's 30 rpm, rad/s."""

CLOSING = 0.02
"""tau of the limited servo, s: assumed, short beside the periods; it rounds the triangle's
corners, where a servo without it would have to reverse within no time."""

_LEVELS = np.linspace(0.0, 1.4, 57)
"""Commanded amplitudes between which the limited servo is interpolated, rad."""
_PERIODS, _STEPS_PER_SAMPLE = 12, 8


class Angle(NamedTuple):
    """phi, its rate and its acceleration at n samples of half a period, (n, G); rad, s."""

    phi: Array
    rate: Array
    bend: Array


def sine(amplitude: Array, period: Array, n: int) -> Angle:
    """The command, sampled in the middle of n steps; amplitude (rad), period (s), (G,)."""
    theta = (np.arange(n)[:, None] + 0.5) * math.pi / n
    omega = 2 * math.pi / period
    swing = amplitude * np.sin(theta)
    return Angle(swing, amplitude * omega * np.cos(theta), -(omega**2) * swing)


def lagging(amplitude: Array, period: Array, lag: Array, n: int) -> Angle:
    """What a first-order lag (s, (G,)) leaves of the command."""
    return sine(amplitude / np.hypot(1.0, lag * 2 * math.pi / period), period, n)


def limited(amplitude: Array, period: Array, n: int) -> Angle:
    """What the limited servo makes of it; amplitudes up to 1.4 rad."""
    parts = np.empty((3, n, len(amplitude)))
    at = amplitude / _LEVELS[1]
    below = np.clip(at.astype(int), 0, len(_LEVELS) - 2)
    above = at - below
    for T in np.unique(period):
        here = period == T
        table = _response(float(T), n)
        low, share = below[here], above[here]
        parts[:, :, here] = table[:, :, low] * (1 - share) + table[:, :, low + 1] * share
    return Angle(*parts)


@lru_cache
def _response(period: float, n: int) -> Array:
    """phi, rate and acceleration (3, n, levels) of half a steady period, by classical RK4."""
    omega, steps = 2 * math.pi / period, n * _STEPS_PER_SAMPLE
    h = period / 2 / steps

    def rate(t: float, phi: Array) -> Array:
        return RATE_LIMIT * np.tanh((_LEVELS * math.sin(omega * t) - phi) / (RATE_LIMIT * CLOSING))

    phi, found = np.zeros_like(_LEVELS), np.empty((3, n, len(_LEVELS)))
    half_periods = 2 * _PERIODS
    for half in range(half_periods):
        for step in range(steps):
            t = half * period / 2 + step * h
            k1 = rate(t, phi)
            if half == half_periods - 1 and step % _STEPS_PER_SAMPLE == _STEPS_PER_SAMPLE // 2:
                share = 1 - (k1 / RATE_LIMIT) ** 2
                bend = share * (_LEVELS * omega * math.cos(omega * t) - k1) / CLOSING
                found[:, step // _STEPS_PER_SAMPLE] = phi, k1, bend
            k2 = rate(t + h / 2, phi + h / 2 * k1)
            k3 = rate(t + h / 2, phi + h / 2 * k2)
            phi = phi + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(t + h, phi + h * k3))
    # The last half period is a second half: its mirror image is the first.
    return -found


_STEPS = 30
_SETTLED = 3e-5
"""A Newton step below this share of the largest |v| is the last."""
_STILL = 1e-7  # m/s
_FIRST_STEP = 0.1  # m/s


def viscous_speed(known: Linear, q: Array, period: Array) -> Array:
    """Mean speed of P (G,), m/s, positive along platform 1; NaN where nothing settles.

    known, q (rad/s): at n equal steps of half a period (n, G); period (s), (G,).
    """
    v, damping = solve(known.slope, known.drive, period / 2)
    return np.where(damping < 0, _mean(v, known, q, period), np.nan)


def dry_speed(known: Linear, rolling: Wheels, force: Array, q: Array, period: Array) -> Array:
    """The same with a dry friction `force` (N, (G,)) at each wheel; samples at mid-step.

    NaN where the search did not settle within its steps.
    """
    step = period / 2 / len(q)
    along, carried = rolling.along_v / SMOOTHING_SPEED, rolling.carried / SMOOTHING_SPEED
    push = force * rolling.along_v / rolling.inertia
    parts = (known.slope, known.drive, along, carried, push)
    v = np.full_like(q, np.nan)
    start = solve(known.slope, known.drive, period / 2)[0][0]
    low, high = np.full(len(step), -np.inf), np.full(len(step), np.inf)
    left = np.arange(len(step))
    for _ in range(_STEPS):
        path, end, gain = _half_period(parts, start, step[left])
        gap = end - start
        move = gap / (1 - gain)
        done = np.abs(move) < _SETTLED * np.abs(path).max(axis=0) + _STILL
        v[:, left[done]] = path[:, done]
        # Friction brakes: the gap falls as the start grows, so its sign says where the cycle is.
        low, high = np.where(gap > 0, start, low), np.where(gap > 0, high, start)
        start = _inside(start, move, gap, low, high)
        going = ~done & np.isfinite(start)
        left, start, low, high = left[going], start[going], low[going], high[going]
        if not len(left):
            break
        parts = tuple(part[..., going] for part in parts)
    return _mean(v, known, q, period)


def _inside(start: Array, move: Array, gap: Array, low: Array, high: Array) -> Array:
    """The next start: Newton's, else the middle of the bracket, else further out."""
    proposed = start + move
    further = start + np.copysign(np.maximum(_FIRST_STEP, np.abs(start)), gap)
    closed = np.isfinite(low) & np.isfinite(high)
    middle = np.where(closed, (np.where(closed, low, 0.0) + np.where(closed, high, 0.0)) / 2,
                      further)  # fmt: skip
    return np.where((proposed > low) & (proposed < high), proposed, middle)


def _half_period(parts: tuple[Array, ...], start: Array, h: Array) -> tuple[Array, Array, Array]:
    """v at mid-step (n, G), v at the end (G,), and how the end moves with the start (G,).

    Each step is exact for the equation linearised where it begins (Rosenbrock-Euler), with the
    coefficients of its middle: of order two, and stable however steep the friction is.
    """
    slope, drive, along, carried, push = parts
    path, v, gain = np.empty_like(drive), start, np.ones_like(start)
    for i in range(len(drive)):
        grip = np.tanh(along[:, i] * v + carried[:, i])
        rate = slope[i] * v + drive[i] - (push[:, i] * grip).sum(axis=0)
        J = slope[i] - (push[:, i] * along[:, i] * (1 - grip**2)).sum(axis=0)
        grown = np.expm1(h * J)
        after = v + rate * grown / J
        path[i] = (v + after) / 2
        v, gain = after, gain * (1 + grown)
    return path, v, gain


def _mean(v: Array, known: Linear, q: Array, period: Array) -> Array:
    """The displacement of P over a period, over the period; see verify.steady_fourier.

    P also moves at -c1 w across platform 1, which adds c1 times the integral of sin(chi) d chi:
    nothing, as cos(chi) is the same half a period later.
    """
    w = known.turn_v * v + known.turn_q * q
    chi = integral(w, period / 2, True)
    ahead = (np.cos(chi) * v).mean(axis=0)
    return np.copysign(ahead, ahead * np.cos(chi).mean(axis=0))
