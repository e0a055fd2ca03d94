"""The ways to fit that are compared, and how much of each is affordable."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module

import numpy as np

from benchmarks.fit.case import TRUE, Array, Case

Fit = Callable[[Case, Array], Array]

OURS, EXAMPLE = "ours", "casadi_sysid"


@dataclass(frozen=True)
class Way:
    """A way to fit.

    needs  the package it cannot do without
    most   how often it is timed from near starts, and from far ones, if less than asked for
    slow   it takes minutes: once from a near start, no process of its own, no far starts
    """

    name: str
    needs: str
    most: int | None = None
    slow: bool = False


WAYS = {
    OURS: Way("this project", "casadi"),
    EXAMPLE: Way("CasADi's example, multiple shooting", "casadi"),
    "numba_horizon": Way("Numba by hand, growing horizon", "numba"),
    "jax_diffrax": Way("JAX: diffrax, SciPy least_squares", "diffrax", most=1),
    "lmfit_leastsq": Way("lmfit, solve_ivp", "lmfit", most=1, slow=True),
    "scipy_solve_ivp": Way("SciPy least_squares, solve_ivp", "scipy", most=1, slow=True),
}

_NEAR = 1.05


def way(module: str) -> Fit:
    """The function `fit(case, start)` of a way."""
    return import_module(f"benchmarks.fit.{module}").fit


def near(count: int) -> Array:
    """Starts (count, 6) with every parameter 5 % off, to either side: everyone gets there."""
    return TRUE * _NEAR ** np.random.default_rng(3).choice([-1, 1], (count, TRUE.size))
