"""JAX: `least_squares` of SciPy with misfit and exact derivatives of diffrax, both compiled.

All recordings are solved at once by `vmap`, in double precision, at one step of Tsit5 a sample;
forward-mode derivatives go through the solver. What is compiled is kept for other starts. With the
solvers of Optimistix instead, from 5 % off, Levenberg-Marquardt was not there after 64 steps and
Gauss-Newton went astray.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.optimize import least_squares

from benchmarks.fit.case import RATE, TRUE, Array, Case, guessed_start
from benchmarks.fit.equations import rates


def fit(case: Case, start: Array) -> Array:
    """The six parameters, from a start."""
    misfit, slopes = _compiled(case)
    unknown = np.concatenate([start / TRUE, np.zeros(4 * len(case.gaits))])
    found = least_squares(
        lambda x: np.asarray(misfit(x)),
        unknown,
        lambda x: np.asarray(slopes(x)),
        x_scale="jac",
        method="lm",
    )
    return found.x[: TRUE.size] * TRUE


@lru_cache(maxsize=1)
def _compiled(case: Case):
    import diffrax as dfx  # pyright: ignore[reportMissingImports]
    import equinox as eqx  # pyright: ignore[reportMissingImports]
    import jax  # pyright: ignore[reportMissingImports]
    import jax.numpy as jnp  # pyright: ignore[reportMissingImports]

    jax.config.update("jax_enable_x64", True)
    gaits, seen = jnp.asarray(case.gaits), jnp.asarray(case.values[:, :, :3])
    sigma, t = jnp.asarray(case.sigma[:3]), jnp.asarray(case.t)

    def vector_field(at, state, given):
        p, (amplitude, period, offset) = given
        turn = 2 * jnp.pi / period
        sine, cosine = amplitude * jnp.sin(turn * at), amplitude * jnp.cos(turn * at)
        drive = (sine + offset, turn * cosine, -(turn**2) * sine)
        return jnp.stack(rates(state, drive, p, jnp.sin, jnp.cos))

    def motion(start, gait, p):
        return dfx.diffeqsolve(
            dfx.ODETerm(vector_field), dfx.Tsit5(), t[0], t[-1], 1 / RATE, start, (p, gait),
            saveat=dfx.SaveAt(ts=t), adjoint=dfx.ForwardMode(),
        ).ys  # fmt: skip

    first = jnp.asarray([guessed_start(case, run) for run in range(len(case.gaits))])

    def misfit(p, starts):
        moved = jax.vmap(motion, (0, 0, None))(starts, gaits, p * TRUE)
        return (moved[:, :, :3] - seen) / sigma

    def flat(unknown):
        starts = first + unknown[TRUE.size :].reshape(first.shape)
        return misfit(unknown[: TRUE.size], starts).ravel()

    return eqx.filter_jit(flat), eqx.filter_jit(jax.jacfwd(flat))
