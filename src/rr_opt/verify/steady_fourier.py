"""Steady cycles of many gaits at once by Fourier series: the model behind the sweep.

Where friction is viscous, vdot = a v + b with a and b known along the gait, and the periodic
solution follows in closed form. Other friction is linearised about the current v, solved so,
and the step repeated (Newton-Kantorovich).

The mirror image of a motion is a motion. A straight gait turns into its mirror image after
half a period, so half a period says everything: v repeats, w, side and torque change sign.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.arrays import over_arrays
from rr_opt.physics.dynamics import Dynamics
from rr_opt.verify.periodic_linear import solve, solve_stiff
from rr_opt.verify.spectral import derivative, integral, peak, refined, tail
from rr_opt.verify.speed_powers import Powers, SpeedPowers

Array = NDArray[np.float64]

_COARSE = 64
"""Samples at which Newton's method starts; each doubling goes on from the last."""

_STEPS = 25
_LAST = 1e-8
"""The last step of Newton's method is no longer than this share of the largest |v|."""
_GIVE_UP = 1e-3
"""So much damping leads nowhere."""


class Steady(NamedTuple):
    """Steady cycles of G shapes at B periods; every array (G, B).

    speed        along the mean circle, signed along platform 1's mean heading, m/s
    turn         heading gained per period, rad
    peak_torque  largest |torque|, between the samples too, N m
    error        what unresolved harmonics may do to the speed, m/s, an estimate; inf where no
                 steady cycle was found
    """

    speed: Array
    turn: Array
    peak_torque: Array
    error: Array


class SteadyFourier:
    """The derived model of a set of effects, evaluated over whole arrays."""

    def __init__(self, dynamics: Dynamics):
        motion, names = dynamics.motion, dynamics.motion.name_in()
        powers = SpeedPowers(dynamics)
        self.viscous = dynamics.linear and powers.reproduce(dynamics)
        self._powers = powers
        self._motion = over_arrays(motion)
        self._tangent = over_arrays(motion.factory("tangent", names, ["vdot", "jac:vdot:v"]))

    def cycles(
        self, amplitude: Array, offset: Array, period: Array, p: Array, n: int, straight: bool
    ) -> Steady:
        """Steady cycles from n samples of half a period if straight, else of a whole one.

        amplitude, offset (G,), rad, all offsets 0 if straight; period (G, B), s; p the robots'
        parameters, (len, G) or (len, 1); n a power of two.
        """
        theta = np.arange(n)[:, None] * ((1 if straight else 2) * math.pi / n)
        swing, rate = amplitude * np.sin(theta), amplitude * np.cos(theta)
        span = (period / 2 if straight else period).ravel()
        omega = 2 * math.pi / period
        method = self._by_powers if self.viscous else self._by_newton
        v, w, side, torque, settled = method(offset, swing, rate, omega, p, span)
        speed, turn = _mean_speed(v, w, side, span, straight)
        error = tail(v, False) + tail(side, straight)
        error = np.where(settled & np.isfinite(speed), error, np.inf)
        results = (speed, turn, peak(torque, straight), error)
        return Steady(*(result.reshape(period.shape) for result in results))

    def _by_powers(
        self, offset: Array, swing: Array, rate: Array, omega: Array, p: Array, span: Array
    ) -> tuple[Array, Array, Array, Array, Array]:
        c = Powers(*(part[..., None] for part in self._powers(swing + offset, p)))
        q, r = rate[..., None], -swing[..., None]
        shape = (len(swing), *omega.shape)
        # In powers of omega: what stands in brackets is computed once for all periods.
        a = (c.a_vq * q) * omega + c.a_v
        b = ((c.a_qq * q**2 + c.a_r * r) * omega + c.a_q * q) * omega
        v, mean = solve(a.reshape(len(a), -1), b.reshape(len(b), -1), span)
        u = v.reshape(shape)
        w = c.w_v * u + (c.w_q * q) * omega
        side = c.s_v * u + (c.s_q * q) * omega
        torque = (c.t_vv * u + (c.t_vq * q) * omega + c.t_v) * u
        torque += ((c.t_qq * q**2 + c.t_r * r) * omega + c.t_q * q) * omega
        w, side, torque = (part.reshape(v.shape) for part in (w, side, torque))
        return v, w, side, torque, mean < 0

    def _by_newton(
        self, offset: Array, swing: Array, rate: Array, omega: Array, p: Array, span: Array
    ) -> tuple[Array, Array, Array, Array, Array]:
        periods = omega.shape[1]
        phi, swing, rate = (
            np.repeat(part, periods, axis=1) for part in (swing + offset, swing, rate)
        )
        omega = omega.ravel()
        if p.shape[1] > 1:
            p = np.repeat(p, periods, axis=1)
        angle = np.array([phi, rate * omega, -swing * omega**2])
        v, settled = self._newton(angle, p, span)
        _, w, side, torque = self._motion(v, *angle, *p)
        return v, w, side, torque, settled

    def _newton(self, angle: Array, p: Array, span: Array) -> tuple[Array, NDArray[np.bool_]]:
        """v (n, K) along phi, dphi, ddphi (3, n, K), and where the steps have died out (K,)."""
        n = angle.shape[1]
        if n > _COARSE:
            v = refined(self._newton(angle[:, ::2], p, span)[0])
        else:
            # The chord of vdot from v = -1 to 1 m/s: to it dry friction is a small matter.
            low, high = (self._motion(v, *angle, *p)[0] for v in (-1.0, 1.0))
            v = solve_stiff((high - low) / 2, (high + low) / 2, span)[0]
        columns = np.arange(len(span))
        settled = np.zeros(len(span), bool)
        damp, before = np.ones(len(span)), np.full(len(span), np.inf)
        for _ in range(_STEPS):
            here, robots = v[:, columns], p[:, columns] if p.shape[1] > 1 else p
            vdot, slope = self._tangent(here, *angle[:, :, columns], *robots)
            rest = vdot - derivative(here, span[columns])
            step, mean = solve_stiff(slope, rest, span[columns])
            size = np.abs(step).max(axis=0)
            damp = np.where(size > 0.9 * before, damp / 2, np.minimum(1.5 * damp, 1.0))
            v[:, columns] = here + damp * step
            done = (size <= _LAST * np.abs(here).max(axis=0)) & (mean < 0)
            settled[columns[done]] = True
            lost = ~np.isfinite(size) | (damp < _GIVE_UP)
            going = ~(done | lost)
            columns, damp, before = columns[going], damp[going], size[going]
            if not len(columns):
                break
        return v, settled


def _mean_speed(
    v: Array, w: Array, side: Array, span: Array, straight: bool
) -> tuple[Array, Array]:
    """Signed mean speed (m/s) and turn (rad), (K,).

    chi = psi - turn t/T is periodic. V is the mean of P's velocity in the frame that turns with
    the gait, E the mean heading there, which says what is forward.
    """
    chi = integral(w, span, straight)
    cos, sin = np.cos(chi), np.sin(chi)
    Vx, Ex = (cos * v - sin * side).mean(axis=0), cos.mean(axis=0)
    if straight:
        # In the mirror image sideways is the other way: Vy = Ey = 0 over the whole period.
        return np.copysign(Vx, Vx * Ex), np.zeros_like(Vx)
    Vy, Ey = (sin * v + cos * side).mean(axis=0), sin.mean(axis=0)
    return np.copysign(np.hypot(Vx, Vy), Vx * Ex + Vy * Ey), span * w.mean(axis=0)
