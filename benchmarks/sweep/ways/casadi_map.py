"""CasADi: a Runge-Kutta integrator by mapaccum over the steps, `map` over the points."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from benchmarks.sweep.case import Array, Work
from benchmarks.sweep.equations import rates
from benchmarks.sweep.fixed_point import secant

NAME = "CasADi RK4, mapaccum and map"


@lru_cache
def _integrator(friction: str, steps: int, count: int):
    """(start (4, K), drift, alpha, T, phi0 (1, K), p (15, K)) -> the state (4, K) a period on."""
    import casadi as ca

    motion = rates(ca.sin, ca.cos, ca.tanh, ca.sqrt, friction)
    state, step = ca.SX.sym("state", 4), ca.SX.sym("step")
    given = ca.SX.sym("given", 19)
    drift, alpha, T, phi0 = ca.vertsplit(given[:4])
    p, omega, h = ca.vertsplit(given[4:]), 2 * np.pi / T, T / steps

    def derivative(x, t):
        swing = alpha * ca.sin(omega * t)
        rate = alpha * omega * ca.cos(omega * t)
        a, w, side = motion(x[0], swing + phi0, rate, -swing * omega**2, p)
        cosine, sine = ca.cos(x[1]), ca.sin(x[1])
        return ca.vertcat(a, w - drift, cosine * x[0] - sine * side, sine * x[0] + cosine * side)

    t = step * h
    k1 = derivative(state, t)
    k2 = derivative(state + h / 2 * k1, t + h / 2)
    k3 = derivative(state + h / 2 * k2, t + h / 2)
    k4 = derivative(state + h * k3, t + h)
    ahead = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    one = ca.Function("rk4", [state, step, given], [ahead])
    start, whole = ca.MX.sym("start", 4), ca.MX.sym("given", 19)
    ends = one.mapaccum(steps)(start, ca.DM(np.arange(steps)).T, ca.repmat(whole, 1, steps))
    return ca.Function("period", [start, whole], [ends[:, -1]]).map(count)


def run(work: Work, steps: int) -> Array:
    """|speed| (K,) with the given number of steps per period."""
    period_of = _integrator(work.friction, steps, work.size)
    gaits = (work.amplitude, work.period, work.offset)
    still = np.zeros(work.size)

    def ahead(v: Array, drift: Array) -> Array:
        given = np.stack([drift, *gaits, *work.parameters])
        return np.asarray(period_of(np.stack([v, still, still, still]), given))

    def period(v: Array) -> tuple[Array, Array]:
        end = ahead(v, still)
        return end[0], end[1]

    v, turn = secant(period, still, affine=work.friction == "viscous")
    end = ahead(v, turn / work.period)
    return np.hypot(end[2], end[3]) / work.period
