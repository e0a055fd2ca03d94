"""JAX: classical Runge-Kutta of fourth order by lax.scan, vmap over the points, jit, 64 bits."""

from __future__ import annotations

from functools import lru_cache, partial

import numpy as np

from benchmarks.sweep.case import Array, Work
from benchmarks.sweep.equations import rates

NAME = "JAX RK4 (jit, vmap, lax.scan)"


@lru_cache
def _compiled(friction: str):
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    motion = rates(jnp.sin, jnp.cos, jnp.tanh, jnp.sqrt, friction)

    def derivative(state, t, drift, gait, p):
        v, angle = state[0], state[1]
        alpha, T, phi0 = gait
        omega = 2 * jnp.pi / T
        swing = alpha * jnp.sin(omega * t)
        rate = alpha * omega * jnp.cos(omega * t)
        a, w, side = motion(v, swing + phi0, rate, -swing * omega**2, p)
        cosine, sine = jnp.cos(angle), jnp.sin(angle)
        path = (cosine * v - sine * side, sine * v + cosine * side)
        return jnp.stack([a, w - drift, *path][: state.shape[0]])

    def integrated(start, drift, gait, p, steps):
        h = gait[1] / steps

        def step(state, k):
            t = k * h
            k1 = derivative(state, t, drift, gait, p)
            k2 = derivative(state + h / 2 * k1, t + h / 2, drift, gait, p)
            k3 = derivative(state + h / 2 * k2, t + h / 2, drift, gait, p)
            k4 = derivative(state + h * k3, t + h, drift, gait, p)
            return state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), None

        return jax.lax.scan(step, start, jnp.arange(steps))[0]

    def point(gait, p, steps):
        def period(v):
            end = integrated(jnp.stack([v, 0.0 * v]), 0.0, gait, p, steps)
            return end[0], end[1]

        zero = 0.0 * gait[1]
        if friction == "viscous":
            (end, turn), (other, far) = period(zero), period(zero + 1.0)
            v = end / (1 - (other - end))
            turn = turn + (far - turn) * v
        else:
            first = period(zero)[0]

            def going(carry):
                _, _, _, step, k = carry
                return (jnp.abs(step) > 1e-9 * jnp.maximum(jnp.abs(carry[2]), 1e-3)) & (k < 30)

            def secant(carry):
                before, gap, v, _, k = carry
                next_gap = period(v)[0] - v
                apart = next_gap - gap
                step = -next_gap * (v - before) / jnp.where(apart == 0, 1.0, apart)
                return v, next_gap, v + step, step, k + 1

            carry = (zero, first, first, zero + 1.0, 0)
            v = jax.lax.while_loop(going, secant, carry)[2]
            turn = period(v)[1]
        start = jnp.stack([v, zero, zero, zero])
        end = integrated(start, turn / gait[1], gait, p, steps)
        return jnp.hypot(end[2], end[3]) / gait[1]

    @partial(jax.jit, static_argnums=2)
    def speeds(gaits, p, steps):
        return jax.vmap(lambda gait, own: point(gait, own, steps))(gaits, p)

    return speeds


def run(work: Work, steps: int) -> Array:
    """|speed| (K,) with the given number of steps per period."""
    gaits = np.stack([work.amplitude, work.period, work.offset], axis=1)
    return np.asarray(_compiled(work.friction)(gaits, work.parameters.T, steps))
