"""NumPy: classical Runge-Kutta of fourth order, all points at once."""

from __future__ import annotations

import numpy as np

from benchmarks.sweep.case import Array, Work
from benchmarks.sweep.equations import rates
from benchmarks.sweep.fixed_point import secant

NAME = "NumPy RK4, all points at once"


def run(work: Work, steps: int) -> Array:
    """|speed| (K,) with the given number of steps per period."""
    motion = rates(np.sin, np.cos, np.tanh, np.sqrt, work.friction)
    p, T = work.parameters, work.period
    omega, h = 2 * np.pi / T, T / steps

    def phase(t: float) -> tuple[Array, Array, Array]:
        wave = 2 * np.pi * t / steps
        swing = work.amplitude * np.sin(wave)
        rate = work.amplitude * omega * np.cos(wave)
        return swing + work.offset, rate, -swing * omega**2

    def period(v: Array) -> tuple[Array, Array]:
        psi = np.zeros_like(v)
        for k in range(steps):
            at = phase(k), phase(k + 0.5), phase(k + 1)
            a1, w1, _ = motion(v, *at[0], p)
            a2, w2, _ = motion(v + h / 2 * a1, *at[1], p)
            a3, w3, _ = motion(v + h / 2 * a2, *at[1], p)
            a4, w4, _ = motion(v + h * a3, *at[2], p)
            v = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
            psi = psi + h / 6 * (w1 + 2 * w2 + 2 * w3 + w4)
        return v, psi

    v, turn = secant(period, np.zeros(work.size), affine=work.friction == "viscous")

    def path(v: Array, angle: Array, t: float) -> tuple[Array, Array, Array, Array]:
        a, w, side = motion(v, *phase(t), p)
        cosine, sine = np.cos(angle), np.sin(angle)
        return a, w - turn / T, cosine * v - sine * side, sine * v + cosine * side

    angle, x, y = (np.zeros_like(v) for _ in range(3))
    for k in range(steps):
        k1 = path(v, angle, k)
        k2 = path(v + h / 2 * k1[0], angle + h / 2 * k1[1], k + 0.5)
        k3 = path(v + h / 2 * k2[0], angle + h / 2 * k2[1], k + 0.5)
        k4 = path(v + h * k3[0], angle + h * k3[1], k + 1)
        v, angle, x, y = (
            one + h / 6 * (a + 2 * b + 2 * c + d)
            for one, a, b, c, d in zip((v, angle, x, y), k1, k2, k3, k4, strict=True)
        )
    return np.hypot(x, y) / T
