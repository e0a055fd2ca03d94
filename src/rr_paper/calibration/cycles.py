"""Mean speeds of straight steady cycles of thousands of robots, with any servo or friction.

This is separate from `rr_opt.verify.speeds`, which also gives the torque, at five times the cost,
for one robot, exact sines and the friction of the catalogue. The derived equation of motion is
evaluated over arrays, as coefficients that depend on the posture alone. With q = dphi and r = ddphi
viscous friction gives

    vdot = (a_vq q + a_v) v + a_qq q^2 + a_q q + a_r r,     w = w_v v + w_q q

and wheel i rolls at u_i = p_i v + s_i q. Dry friction adds -sum F(u_i) p_i/inertia to vdot; then
half a period is integrated, and Newton's method inside a bracket adjusts the initial speed to match
the final one.

Angles that the servo makes of a commanded sine, in steady motion:

lagging     with a first-order lag: smaller by sqrt(1 + (tau omega)^2), and delayed, which does not
            change a mean speed
limited     dphi/dt = R tanh((command - phi)/(R tau)): like a lag of tau, but no faster than R. If
            commanded faster it runs at R all the time, and the angle becomes a triangle of
            amplitude R T/4 whatever the command.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.effects.coulomb_friction import SMOOTHING_SPEED
from rr_opt.mechanics.code_generation import ArrayFunction, over_arrays
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS, mechanism
from rr_opt.motion.dynamics import derive
from rr_opt.verify.fourier import solve
from rr_paper.publication import RATE_LIMIT
from rr_paper.signs import Angle, mean_speed, sine


class Coefficients(NamedTuple):
    """vdot = slope v + drive and w = turn v + yaw along an angle, (n, G) each, SI."""

    slope: Array
    drive: Array
    turn: Array
    yaw: Array


def coefficients(angle: Angle, p: Array) -> Coefficients:
    """p: values of ROBOT_PARAMETERS, (13, G)."""
    phi, q, r = angle
    a_vq, a_v, a_qq, a_q, a_r, w_v, w_q = _functions()[0](phi, *p)
    return Coefficients(a_vq * q + a_v, (a_qq * q + a_q) * q + a_r * r, w_v, w_q * q)


@lru_cache
def _functions() -> tuple[ArrayFunction, ArrayFunction]:
    """Of (phi, *p): the coefficients above; and p_i, s_i of the four wheels with the inertia seen
    by v, kg."""
    dynamics, robot = derive(()), mechanism()
    phi, p = ca.SX.sym("phi"), ca.SX.sym("p", len(ROBOT_PARAMETERS))
    v, q, r = (ca.SX.sym(name) for name in "vqr")
    vdot, w, _, _ = dynamics.motion(v, phi, q, r, p)
    curvature = ca.hessian(vdot, ca.vertcat(v, q))[0]
    inertia = ca.hessian(dynamics.energy(v, phi, q, p)[0], v)[0]
    symbols = ca.vertcat(robot.phi, robot.speeds, *(robot.parameters[n] for n in ROBOT_PARAMETERS))
    rolling = [
        ca.substitute(robot.rolling_speed(wheel), symbols, ca.vertcat(phi, v, 0, 0, q, p))
        for wheel in robot.wheels
    ]

    def at_rest(name: str, *parts: ca.SX) -> ArrayFunction:
        values = ca.substitute(ca.vertcat(*parts), ca.vertcat(v, q, r), ca.SX.zeros(3))
        return over_arrays(ca.Function(name, [phi, p], ca.vertsplit(ca.cse(values))))

    a_v, a_q, a_r = (ca.jacobian(vdot, x) for x in (v, q, r))
    turning = (ca.jacobian(w, x) for x in (v, q))
    wheels = (ca.jacobian(u, x) for x in (v, q) for u in rolling)
    return (
        at_rest("linear", curvature[0, 1], a_v, curvature[1, 1] / 2, a_q, a_r, *turning),
        at_rest("wheels", *wheels, inertia),
    )


TAU = 0.02
"""tau of the limited servo, s: assumed, short compared with the periods; it rounds the triangle's
corners, where the servo would otherwise have to reverse instantly."""

_LEVELS = np.linspace(0.0, 1.4, 57)
"""Commanded amplitudes of the interpolation table of the limited servo, rad."""
_PERIODS, _STEPS_PER_SAMPLE = 12, 8


def lagging(amplitude: Array, period: Array, lag: Array, n: int) -> Angle:
    """The command with a first-order lag (s, (G,))."""
    return sine(amplitude / np.hypot(1.0, lag * 2 * math.pi / period), period, n)


def limited(amplitude: Array, period: Array, n: int) -> Angle:
    """The response of the limited servo to the command; amplitudes up to 1.4 rad."""
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
        return RATE_LIMIT * np.tanh((_LEVELS * math.sin(omega * t) - phi) / (RATE_LIMIT * TAU))

    phi, samples = np.zeros_like(_LEVELS), np.empty((3, n, len(_LEVELS)))
    halves = 2 * _PERIODS
    for half in range(halves):
        for step in range(steps):
            t = half * period / 2 + step * h
            k1 = rate(t, phi)
            if half == halves - 1 and step % _STEPS_PER_SAMPLE == _STEPS_PER_SAMPLE // 2:
                share = 1 - (k1 / RATE_LIMIT) ** 2
                acceleration = share * (_LEVELS * omega * math.cos(omega * t) - k1) / TAU
                samples[:, step // _STEPS_PER_SAMPLE] = phi, k1, acceleration
            k2 = rate(t + h / 2, phi + h / 2 * k1)
            k3 = rate(t + h / 2, phi + h / 2 * k2)
            phi = phi + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(t + h, phi + h * k3))
    # The last half period is a second half, the mirror image of the first.
    return -samples


_ITERATIONS = 30
_CONVERGED = 3e-5
"""The iteration ends with a Newton step below this share of the largest |v|."""
_STILL = 1e-7  # m/s
_FIRST_STEP = 0.1  # m/s


def viscous_speed(found: Coefficients, period: Array) -> Array:
    """Mean speed of P (G,), m/s, positive along platform 1; NaN where no motion is steady."""
    v, damping, _ = solve(found.slope, found.drive, period / 2)
    return np.where(damping < 0, mean_speed(v, found.turn * v + found.yaw, period), np.nan)


def dry_speed(angle: Angle, period: Array, p: Array, force: Array) -> Array:
    """The same with a dry friction `force` (N, (G,)) at each wheel.

    angle: sampled in the middle of its steps. NaN where the search did not converge.
    """
    slope, drive, turn, yaw = coefficients(angle, p)
    *rolling, inertia = (np.broadcast_to(x, slope.shape) for x in _functions()[1](angle.phi, *p))
    rolling_v, rolling_q = np.array(rolling[:4]), np.array(rolling[4:]) * angle.rate
    start = solve(slope, drive, period / 2)[0][0]
    push = force * rolling_v / inertia
    parts = (slope, drive, rolling_v / SMOOTHING_SPEED, rolling_q / SMOOTHING_SPEED, push)
    step = period / 2 / len(slope)
    v = np.full_like(slope, np.nan)
    low, high = np.full(len(step), -np.inf), np.full(len(step), np.inf)
    left = np.arange(len(step))
    for _ in range(_ITERATIONS):
        path, end, gain = _half_period(parts, start, step[left])
        gap = end - start
        move = gap / (1 - gain)
        done = np.abs(move) < _CONVERGED * np.abs(path).max(axis=0) + _STILL
        v[:, left[done]] = path[:, done]
        # Friction brakes: the gap falls as the start grows, so its sign brackets the cycle.
        low, high = np.where(gap > 0, start, low), np.where(gap > 0, high, start)
        start = _next_start(start, move, gap, low, high)
        going = ~done & np.isfinite(start)
        left, start, low, high = left[going], start[going], low[going], high[going]
        if not len(left):
            break
        parts = tuple(part[..., going] for part in parts)
    return mean_speed(v, turn * v + yaw, period)


def _next_start(start: Array, move: Array, gap: Array, low: Array, high: Array) -> Array:
    """The Newton step, else the middle of the bracket, else further out."""
    proposed = start + move
    further = start + np.copysign(np.maximum(_FIRST_STEP, np.abs(start)), gap)
    closed = np.isfinite(low) & np.isfinite(high)
    middle = (np.where(closed, low, 0.0) + np.where(closed, high, 0.0)) / 2
    inside = (proposed > low) & (proposed < high)
    return np.where(inside, proposed, np.where(closed, middle, further))


def _half_period(parts: tuple[Array, ...], start: Array, h: Array) -> tuple[Array, Array, Array]:
    """v at mid-step (n, G), v at the end (G,), and its derivative by the start (G,).

    Each step is exact for the equation linearised at its beginning (Rosenbrock-Euler), with the
    coefficients of its middle: of order two, and stable however steep the friction is.
    """
    slope, drive, rolling_v, rolling_q, push = parts
    path, v, gain = np.empty_like(drive), start, np.ones_like(start)
    for i in range(len(drive)):
        grip = np.tanh(rolling_v[:, i] * v + rolling_q[:, i])
        rate = slope[i] * v + drive[i] - (push[:, i] * grip).sum(axis=0)
        J = slope[i] - (push[:, i] * rolling_v[:, i] * (1 - grip**2)).sum(axis=0)
        grown = np.expm1(h * J)
        after = v + rate * grown / J
        path[i] = (v + after) / 2
        v, gain = after, gain * (1 + grown)
    return path, v, gain
