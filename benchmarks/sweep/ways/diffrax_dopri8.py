"""diffrax: Dopri8 with its step-size controller, vmap over the points, jit, 64 bits."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from benchmarks.sweep.case import Array, Work
from benchmarks.sweep.equations import rates

NAME = "diffrax Dopri8, PIDController"
TOLERANCE = 1e-9


@lru_cache
def _compiled(friction: str):
    import diffrax
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    motion = rates(jnp.sin, jnp.cos, jnp.tanh, jnp.sqrt, friction)

    def field(t, state, args):
        gait, drift, p = args
        alpha, T, phi0 = gait
        omega = 2 * jnp.pi / T
        swing = alpha * jnp.sin(omega * t)
        rate = alpha * omega * jnp.cos(omega * t)
        v, angle = state[0], state[1]
        a, w, side = motion(v, swing + phi0, rate, -swing * omega**2, p)
        cosine, sine = jnp.cos(angle), jnp.sin(angle)
        path = (cosine * v - sine * side, sine * v + cosine * side)
        return jnp.stack([a, w - drift, *path][: state.shape[0]])

    term, solver = diffrax.ODETerm(field), diffrax.Dopri8()
    control = diffrax.PIDController(rtol=TOLERANCE, atol=TOLERANCE / 10)

    def integrated(start, drift, gait, p):
        found = diffrax.diffeqsolve(
            term, solver, 0.0, gait[1], gait[1] / 100, start, (gait, drift, p),
            saveat=diffrax.SaveAt(t1=True), stepsize_controller=control, max_steps=100_000,
            adjoint=diffrax.ForwardMode(),
        )  # fmt: skip
        assert found.ys is not None
        return found.ys[0]

    def point(gait, p):
        def period(v):
            end = integrated(jnp.stack([v, 0.0 * v]), 0.0, gait, p)
            return end[0], end[1]

        zero = 0.0 * gait[1]
        if friction == "viscous":
            (end, turn), (other, far) = period(zero), period(zero + 1.0)
            v = end / (1 - (other - end))
            turn = turn + (far - turn) * v
        else:
            first = period(zero)[0]

            def going(carry):
                _, _, v, step, k = carry
                return (jnp.abs(step) > 1e-8 * jnp.maximum(jnp.abs(v), 1e-3)) & (k < 15)

            def secant(carry):
                before, gap, v, _, k = carry
                next_gap = period(v)[0] - v
                apart = next_gap - gap
                step = -next_gap * (v - before) / jnp.where(apart == 0, 1.0, apart)
                return v, next_gap, v + step, step, k + 1

            v = jax.lax.while_loop(going, secant, (zero, first, first, zero + 1.0, 0))[2]
            turn = period(v)[1]
        start = jnp.stack([v, zero, zero, zero])
        end = integrated(start, turn / gait[1], gait, p)
        return jnp.hypot(end[2], end[3]) / gait[1]

    return jax.jit(jax.vmap(point))


def run(work: Work, _steps: int) -> Array:
    """|speed| (K,)."""
    gaits = np.stack([work.amplitude, work.period, work.offset], axis=1)
    return np.asarray(_compiled(work.friction)(gaits, work.parameters.T))
