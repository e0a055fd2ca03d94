"""Steady cycles of many gaits at once by Fourier series: the model behind the sweep.

Where friction is viscous, vdot = a v + b with a and b known along the gait, and the periodic
solution of a linear equation is had in closed form from their spectra. Other friction is
linearised about the current v, solved so, and the step repeated (Newton-Kantorovich).

The mirror image of a motion is a motion. A straight gait turns into its mirror image after
half a period, so half a period says everything: v repeats, w, side and torque change sign.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.arrays import over_arrays
from rr_opt.physics.dynamics import Dynamics
from rr_opt.verify.spectral import derivative, integral, resampled, solve_linear, tail

Array = NDArray[np.float64]

_NEWTON_STEPS = 40
_NEWTON_ENOUGH = 1e-11


@dataclass(frozen=True)
class Steady:
    """Steady cycles of K gaits; every array (K,).

    speed        along the mean circle, signed along platform 1's mean heading, m/s
    turn         heading gained per period, rad
    peak_torque  largest |torque|, between the samples too, N m
    error        what the unresolved harmonics may do to the speed, m/s, an estimate
    settled      a steady cycle was found
    v            (n, K) at the samples, m/s
    """

    speed: Array
    turn: Array
    peak_torque: Array
    error: Array
    settled: NDArray[np.bool_]
    v: Array


class SteadyFourier:
    """The derived model of a set of effects, evaluated over whole arrays."""

    def __init__(self, dynamics: Dynamics):
        names, motion = dynamics.motion.name_in(), dynamics.motion
        self._linear = dynamics.linear
        self._rates = over_arrays(motion.factory("rates", names, ["vdot", "w", "side"]))
        self._torque = over_arrays(motion.factory("torque", names, ["torque"]))
        self._tangent = over_arrays(motion.factory("tangent", names, ["vdot", "jac:vdot:v"]))

    def cycles(
        self, gaits: Array, p: Array, n: int, straight: bool, guess: Array | None = None
    ) -> Steady:
        """Steady cycles at n samples (n even) of half a period if straight, else of a period.

        gaits (3, K): amplitude, period, offset, all offsets 0 if straight; p (parameters, K) or
        (parameters, 1); guess (n, K): v to start from, if friction is not viscous.
        """
        amplitude, period, offset = gaits
        span = period / 2 if straight else period
        theta = np.arange(n)[:, None] * ((1 if straight else 2) * math.pi / n)
        omega = 2 * math.pi / period
        swing = amplitude * np.sin(theta)
        angle = (swing + offset, amplitude * omega * np.cos(theta), -(omega**2) * swing)
        if self._linear:
            both = np.array([0.0, 1.0])[:, None, None]
            vdot, w, side = self._rates(both, *angle, *p)
            v, damping = solve_linear(vdot[1] - vdot[0], vdot[0], span)
            w, side = (rate[0] + (rate[1] - rate[0]) * v for rate in (w, side))
            settled = damping < 0
        else:
            v, settled = self._newton(angle, p, span, guess)
            _, w, side = self._rates(v, *angle, *p)
        speed, turn, error = _mean_speed(v, w, side, period, span, straight)
        torque = self._torque(v, *angle, *p)[0]
        peak = _peak(resampled(torque, straight))
        return Steady(speed, turn, peak, error, settled & np.isfinite(speed), v)

    def _newton(
        self, angle: tuple[Array, ...], p: Array, span: Array, guess: Array | None
    ) -> tuple[Array, NDArray[np.bool_]]:
        if guess is None:
            # The line through vdot at v = -1 and 1 m/s: dry friction hardly counts.
            low, high = (self._rates(v, *angle, *p)[0] for v in (-1.0, 1.0))
            guess = solve_linear((high - low) / 2, (high + low) / 2, span)[0]
        v = guess
        for k in range(_NEWTON_STEPS):
            vdot, a = self._tangent(v, *angle, *p)
            rest = vdot - derivative(v, span)
            step, damping = solve_linear(a, rest, span)
            v = v + step
            size = np.abs(step).max(axis=0)
            print(k, np.median(size), size.max(), (size<1e-9).mean())
        return v, damping < 0


def _mean_speed(
    v: Array, w: Array, side: Array, period: Array, span: Array, straight: bool
) -> tuple[Array, Array, Array]:
    """Signed mean speed (m/s), turn (rad) and an estimate of the speed's error (m/s).

    chi = psi - turn t/T is periodic. V is the mean of P's velocity in the frame that turns
    with the gait; E the mean heading there, which says what is forward.
    """
    chi = integral(w, span, straight)
    cos, sin = np.cos(chi), np.sin(chi)
    Vx, Ex = (cos * v - sin * side).mean(axis=0), cos.mean(axis=0)
    if straight:
        # The mirror image cancels what points sideways.
        speed, turn = Vx * np.sign(Ex), np.zeros_like(Vx)
    else:
        Vy, Ey = (sin * v + cos * side).mean(axis=0), sin.mean(axis=0)
        speed = np.copysign(np.hypot(Vx, Vy), Vx * Ex + Vy * Ey)
        turn = period * w.mean(axis=0)
    error = tail(v, False) + tail(side, straight)
    return speed, turn, error


def _peak(torque: Array) -> Array:
    """Largest |torque| (K,), by a parabola through the largest sample and its neighbours."""
    size = np.abs(torque)
    top = size.argmax(axis=0)
    column = np.arange(size.shape[1])
    left, middle, right = (size[(top + k) % len(size), column] for k in (-1, 0, 1))
    bend = left - 2 * middle + right
    return middle - (right - left) ** 2 / (8 * np.where(bend < 0, bend, -np.inf))
