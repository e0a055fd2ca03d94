"""SciPy: solve_ivp, one point after the other; the steady cycle as a fixed point of the period."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root_scalar

from benchmarks.sweep.case import Array, Work
from benchmarks.sweep.equations import rates

NAME = "SciPy solve_ivp (DOP853)"
TOLERANCE = 1e-9


def run(work: Work, _steps: int) -> Array:
    """|speed| (K,)."""
    motion = rates(math.sin, math.cos, math.tanh, math.sqrt, work.friction)
    points = zip(work.amplitude, work.period, work.offset, work.parameters.T, strict=True)
    affine = work.friction == "viscous"
    return np.array([_speed(motion, *map(float, one[:3]), one[3].tolist(), affine)
                     for one in points])  # fmt: skip


def _speed(motion, alpha: float, T: float, phi0: float, p: list[float], affine: bool) -> float:
    omega = 2 * math.pi / T

    def angle(t: float) -> tuple[float, float, float]:
        swing = alpha * math.sin(omega * t)
        return swing + phi0, alpha * omega * math.cos(omega * t), -swing * omega**2

    def ahead(field, start: list[float]) -> Array:
        found = solve_ivp(
            field, (0.0, T), start, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE / 100
        )
        return found.y[:, -1]

    if affine:
        # Two starts in one system: the period's map is affine.
        def pair(t: float, x: Array) -> list[float]:
            (a, w, _), (b, u, _) = (motion(v, *angle(t), p) for v in x[:2])
            return [a, b, w, u]

        low, high, turn, far = ahead(pair, [0.0, 1.0, 0.0, 0.0])
        v = low / (1 - (high - low))
        turn += (far - turn) * v
    else:

        def single(t: float, x: Array) -> list[float]:
            return list(motion(x[0], *angle(t), p)[:2])

        def gap(v: float) -> float:
            return ahead(single, [v, 0.0])[0] - v

        v = root_scalar(gap, x0=0.0, x1=gap(0.0), method="secant", xtol=1e-10, maxiter=30).root
        turn = ahead(single, [v, 0.0])[1]

    def path(t: float, x: Array) -> list[float]:
        a, w, side = motion(x[0], *angle(t), p)
        cosine, sine = math.cos(x[1]), math.sin(x[1])
        return [a, w - turn / T, cosine * x[0] - sine * side, sine * x[0] + cosine * side]

    end = ahead(path, [v, 0.0, 0.0, 0.0])
    return math.hypot(end[2], end[3]) / T
