"""Points by machine code, each from as many samples as it needs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.verify.compiled_cycles import CompiledCycles, Points
from rr_opt.verify.steady import Speeds

Array = NDArray[np.float64]
_Places = tuple[NDArray[np.int_], NDArray[np.int_]]

MOST = 16384
"""Samples of half a period where friction is not viscous."""

SAFETY = 0.25
"""Where friction turns suddenly, what a doubling of the samples changes depends on where they
fall: the error may be larger. So much of the tolerance is what it may change."""


def by_series(
    compiled: CompiledCycles,
    points: Points,
    p: Array,
    straight: bool,
    first: int,
    fewest: Array,
    worst: float,
    at: _Places,
    into: Speeds,
) -> int:
    """Viscous friction: written to the places `at` where the error is no worse than that.

    first: samples to begin with; fewest: without which a point is not resolved (K,). Returns with
    how many samples NumPy has to go on with the rest.
    """
    pending, n = np.arange(len(points.period)), first
    while len(pending) and n <= compiled.most:
        now = pending[fewest[pending] <= n]
        if len(now):
            found = compiled.viscous(points.only(now), p, n, straight)
            into.keep((at[0][now], at[1][now]), found, found.error <= worst)
            pending = pending[~into.converged[at][pending]]
        n *= 2
    return n


def by_newton(
    compiled: CompiledCycles,
    points: Points,
    p: Array,
    straight: bool,
    first: int,
    tolerance: float,
    at: _Places,
    into: Speeds,
) -> None:
    """Any friction: written to the places `at` where it is resolved to the tolerance."""
    pending, n = np.arange(len(points.period)), first
    while len(pending) and n < MOST * (1 if straight else 2):
        # The few that need many samples are put together, as the points of a vector register
        # all take as many as the worst of them.
        n *= 4
        found = compiled.newton(points.only(pending), p, first, n, straight, SAFETY * tolerance)
        into.keep((at[0][pending], at[1][pending]), found, found.error <= SAFETY * tolerance)
        pending = pending[~into.converged[at][pending]]
