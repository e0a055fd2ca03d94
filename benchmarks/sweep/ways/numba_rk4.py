"""Numba: classical Runge-Kutta of fourth order, one point after the other, compiled."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from benchmarks.sweep.case import Array, Work
from benchmarks.sweep.equations import rates

NAME = "Numba RK4 (njit, one thread)"


@lru_cache
def _compiled(friction: str):  # noqa: PLR0915 - one after the other, as numba's users do
    import numba

    motion = numba.njit(rates(np.sin, np.cos, np.tanh, np.sqrt, friction, numba.njit))
    affine = friction == "viscous"

    @numba.njit
    def derivative(v, drift, t, alpha, phi0, omega, p):
        swing = alpha * np.sin(omega * t)
        rate = alpha * omega * np.cos(omega * t)
        a, w, side = motion(v, swing + phi0, rate, -swing * omega * omega, p)
        return a, w - drift, side

    @numba.njit
    def period(v, T, steps, alpha, phi0, p):
        h, omega, psi = T / steps, 2 * np.pi / T, 0.0
        for k in range(steps):
            t = k * h
            a1, w1, _ = derivative(v, 0.0, t, alpha, phi0, omega, p)
            a2, w2, _ = derivative(v + h / 2 * a1, 0.0, t + h / 2, alpha, phi0, omega, p)
            a3, w3, _ = derivative(v + h / 2 * a2, 0.0, t + h / 2, alpha, phi0, omega, p)
            a4, w4, _ = derivative(v + h * a3, 0.0, t + h, alpha, phi0, omega, p)
            v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            psi += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4)
        return v, psi

    @numba.njit
    def path(v, turn, T, steps, alpha, phi0, p):
        h, omega, drift = T / steps, 2 * np.pi / T, turn / T
        angle, x, y = 0.0, 0.0, 0.0
        for k in range(steps):
            t = k * h
            a1, w1, s1 = derivative(v, drift, t, alpha, phi0, omega, p)
            x1, y1 = np.cos(angle) * v - np.sin(angle) * s1, np.sin(angle) * v + np.cos(angle) * s1
            u, e = v + h / 2 * a1, angle + h / 2 * w1
            a2, w2, s2 = derivative(u, drift, t + h / 2, alpha, phi0, omega, p)
            x2, y2 = np.cos(e) * u - np.sin(e) * s2, np.sin(e) * u + np.cos(e) * s2
            u, e = v + h / 2 * a2, angle + h / 2 * w2
            a3, w3, s3 = derivative(u, drift, t + h / 2, alpha, phi0, omega, p)
            x3, y3 = np.cos(e) * u - np.sin(e) * s3, np.sin(e) * u + np.cos(e) * s3
            u, e = v + h * a3, angle + h * w3
            a4, w4, s4 = derivative(u, drift, t + h, alpha, phi0, omega, p)
            x4, y4 = np.cos(e) * u - np.sin(e) * s4, np.sin(e) * u + np.cos(e) * s4
            v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            angle += h / 6 * (w1 + 2 * w2 + 2 * w3 + w4)
            x += h / 6 * (x1 + 2 * x2 + 2 * x3 + x4)
            y += h / 6 * (y1 + 2 * y2 + 2 * y3 + y4)
        return np.hypot(x, y) / T

    @numba.njit(parallel=False)
    def speeds(alpha, T, phi0, p, steps):
        out = np.empty(alpha.size)
        for k in range(alpha.size):
            own = p[k]
            start = 0.0
            end, turn = period(start, T[k], steps, alpha[k], phi0[k], own)
            other = 1.0 if affine else end
            for _ in range(30):
                next_end, next_turn = period(other, T[k], steps, alpha[k], phi0[k], own)
                gap, next_gap = end - start, next_end - other
                apart = next_gap - gap
                step = -next_gap * (other - start) / apart if apart != 0 else 0.0
                found = other + step
                if affine:
                    turn += (next_turn - turn) * (found - start)
                    other = found
                    break
                start, end, turn, other = other, next_end, next_turn, found
                if abs(step) <= 1e-9 * max(abs(found), 1e-3):
                    turn = period(other, T[k], steps, alpha[k], phi0[k], own)[1]
                    break
            out[k] = path(other, turn, T[k], steps, alpha[k], phi0[k], own)
        return out

    return speeds


def run(work: Work, steps: int) -> Array:
    """|speed| (K,) with the given number of steps per period."""
    p = np.ascontiguousarray(work.parameters.T)
    return _compiled(work.friction)(work.amplitude, work.period, work.offset, p, steps)
