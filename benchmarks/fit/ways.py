"""The ways to fit that are compared, how much of each is affordable, and what is noted of it.

`python -m benchmarks.fit.ways WAY` is one fit in a process of its own, imports and compiling
included.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module

import numpy as np

from benchmarks.fit.case import TRUE, Array, Case, case

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


@dataclass
class Tried:
    """What came of a way.

    warm, far, cold  CPU seconds of fits: warm only of those that reached the minimum
    missed, stopped  how often a warm one did not, and after how many seconds one was given up
    reached          of the far ones;  worst  cost above the least, relative
    """

    warm: list[float] = field(default_factory=list)
    missed: int = 0
    stopped: float = 0.0
    cold: float | None = None
    far: list[float] = field(default_factory=list)
    reached: int = 0
    worst: float = 0.0


PATIENCE = 60.0
"""CPU seconds."""


@contextmanager
def patience(seconds: float) -> Iterator[None]:
    """A fit that takes minutes is stopped: it is enough to know that it does.

    Raises TimeoutError in the body after this many CPU seconds, between lines of Python only.
    """

    def stop(*_: object) -> None:
        raise TimeoutError(f"not done in {seconds:g} CPU s")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def main() -> None:
    print(*way(sys.argv[1])(case(), near(1)[0]).tolist())


if __name__ == "__main__":
    main()
