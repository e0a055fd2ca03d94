"""scipy's differential evolution, as in `benchmarks.optimise.differential_evolution`: a population
of random starts."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

from benchmarks.optimise.differential_evolution import solve as evolve
from benchmarks.optimise.peers.posed import Array, Claim, Posed

NAME = "scipy differential evolution, NumPy Fourier"


def prepare(posed: Posed) -> Callable[[Array], Claim]:
    """The solver of a problem; every call has another seed."""
    seeds = count()

    def solve(start: Array) -> Claim:  # noqa: ARG001
        found = evolve(posed.problem, next(seeds))
        gait = found.gait
        inertia = float(posed.inertia(gait.ratio or 0.0))
        return Claim(gait.amplitude, gait.period, gait.offset, inertia, gait.speed, found.feasible)

    return solve
