"""lmfit as its users write it: named `Parameters` with bounds, `minimize` around `solve_ivp`."""

from __future__ import annotations

import numpy as np

from benchmarks.fit.case import BOX, TRUE, Array, Case
from benchmarks.fit.equations import PARAMETERS
from benchmarks.fit.scipy_solve_ivp import STEP, misfit

_STATE = ("x", "y", "psi", "v")


def fit(case: Case, start: Array) -> Array:
    """The six parameters, from a start."""
    import lmfit  # pyright: ignore[reportMissingImports]

    params = lmfit.Parameters()
    for name, value in zip(PARAMETERS, start / TRUE, strict=True):
        params.add(name, value=value, min=1 / BOX, max=BOX)
    runs = range(len(case.gaits))
    for run in runs:
        for name in _STATE:
            params.add(f"{name}{run}", value=1.0)

    def residual(now) -> Array:
        return misfit(case, np.array([one.value for one in now.values()]))

    found = lmfit.minimize(residual, params, method="leastsq", epsfcn=STEP**2).params
    return np.array([found[name].value for name in PARAMETERS]) * TRUE
