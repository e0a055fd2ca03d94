"""SciPy as its users write it: `least_squares` around `solve_ivp`, one recording after the other.

The unknowns are the parameters, and each start's difference from what was first seen, all near 1.
SciPy's own step for finite differences, 1.5e-8, is less than what an integrator leaves at 1e-8 and
makes the fit stop anywhere: with a wider one it goes on. MINPACK's method is taken, which
knows no bounds.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from benchmarks.fit.case import TRUE, Array, Case, guessed_start
from benchmarks.fit.equations import rates

_RTOL, _ATOL = 1e-8, 1e-9
STEP = 1e-5
"""Of finite differences, relative."""


def fit(case: Case, start: Array) -> Array:
    """The six parameters, from a start."""
    first = np.concatenate([start / TRUE, np.ones(4 * len(case.gaits))])
    found = least_squares(
        lambda x: misfit(case, x), first, method="lm", x_scale="jac", diff_step=STEP
    )
    return found.x[: TRUE.size] * TRUE


def misfit(case: Case, unknown: Array) -> Array:
    """(predicted - recorded)/sigma of x, y and psi, all recordings one after the other."""
    given, sigma, out = (unknown[: TRUE.size] * TRUE).tolist(), np.array(case.sigma[:3]), []
    moved_starts = unknown[TRUE.size :].reshape(-1, 4) - 1
    for run, (gait, values) in enumerate(zip(case.gaits, case.values, strict=True)):
        amplitude, period, offset = gait
        turn = 2 * pi / period

        def slope(t, state, amplitude=amplitude, turn=turn, offset=offset):
            sine, cosine = amplitude * sin(turn * t), amplitude * cos(turn * t)
            drive = (sine + offset, turn * cosine, -turn * turn * sine)
            return rates(state.tolist(), drive, given, sin, cos)

        moved = solve_ivp(
            slope, (case.t[0], case.t[-1]), guessed_start(case, run) + moved_starts[run],
            "LSODA", case.t, rtol=_RTOL, atol=_ATOL,
        )  # fmt: skip
        out.append((moved.y[:3].T - values[:, :3]) / sigma)
    return np.concatenate(out).ravel()
