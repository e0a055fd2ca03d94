"""One way to the speeds of many gaits each; `run(work, steps)` gives |speed| of every point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module

from benchmarks.sweep.case import Array, Work

_HERE = "benchmarks.sweep.ways"


@dataclass(frozen=True)
class Way:
    """One way.

    needs   packages that it imports
    counts  points of one run: viscous, other friction
    steps   whether it takes steps of a period ("rk4"), nodes of one ("nodes"), or neither ("")
    """

    module: str
    function: str
    needs: tuple[str, ...]
    counts: tuple[int, int]
    steps: str = ""

    @property
    def name(self) -> str:
        """As the page calls it."""
        found = import_module(f"{_HERE}.{self.module}")
        return found.PLAIN if self.function == "run_plain" else found.NAME

    @property
    def run(self) -> Callable[[Work, int], Array]:
        """(work, steps) -> |speed|. Raises ImportError where a package is missing."""
        for package in self.needs:
            import_module(package)
        return getattr(import_module(f"{_HERE}.{self.module}"), self.function)


ALL = 10**9
OURS, PLAIN = Way("ours", "run", (), (ALL, 2304)), Way("ours", "run_plain", (), (ALL, 200))
LIMIT = Way("c_fourier", "run", (), (4096, 0), "nodes")
NUMBA = Way("numba_rk4", "run", ("numba",), (1500, 300), "rk4")
NODES = Way("numpy_fourier", "run", (), (4096, 0), "nodes")
WAYS = (
    OURS,
    PLAIN,
    LIMIT,
    NODES,
    NUMBA,
    Way("numpy_rk4", "run", (), (1500, 200), "rk4"),
    Way("jax_rk4", "run", ("jax",), (1500, 300), "rk4"),
    Way("diffrax_dopri8", "run", ("jax", "diffrax"), (300, 16)),
    Way("casadi_map", "run", ("casadi",), (1500, 300), "rk4"),
    Way("scipy_solve_ivp", "run", ("scipy",), (30, 4)),
)
