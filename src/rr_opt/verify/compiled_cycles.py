"""Steady cycles of many gaits as machine code, where a C compiler is at hand.

The same method as `steady_fourier` for viscous friction, some points at a time in the processor's
vector registers, on all processors that are free. Other friction is solved as data/sweep_newton.c
says. Where nothing can be compiled, NumPy does all of it.
"""

from __future__ import annotations

import ctypes
import math
import os
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from importlib.resources import files
from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.c_stages import in_stages
from rr_opt.physics.dynamics import Dynamics
from rr_opt.physics.machine_code import library
from rr_opt.verify.spectral import matrices

Array = NDArray[np.float64]

_FLAGS = (
    *("-O3", "-march=native", "-mprefer-vector-width=512", "-fno-math-errno"),
    *("-fno-trapping-math", "-fPIC", "-shared"),
)
_PIECE = {True: 4096, False: 64}
"""Points that a thread takes at a time, where friction is viscous (True) or not."""


class Gaits(NamedTuple):
    """K sine gaits: amplitude, offset (K,) rad, period (K,) s, and which column of p (len, R) is
    the robot of each (K,)."""

    amplitude: Array
    offset: Array
    period: Array
    which: NDArray[np.int64]
    p: Array


class CompiledCycles:
    """The loops over the points, for the model of one set of effects."""

    def __init__(self, made: ctypes.CDLL) -> None:
        whole, array, real = ctypes.c_longlong, ctypes.c_void_p, ctypes.c_double
        points = [whole, *[array] * 5, ctypes.c_int]
        self._loop = made.rr_viscous
        self._loop.argtypes = [*points, *[whole] * 4, array, array]
        self._loop.restype = ctypes.c_int

    def viscous(self, gaits: Gaits, n: int, straight: bool) -> Array:
        """Speed (m/s), turn (rad), peak torque (N m) and error, (4, K), from n samples, as
        `SteadyFourier.cycles` tells them."""
        table, sizes = _table(n, straight)
        return _in_threads(self._loop, gaits, int(straight), n, *sizes, table.ctypes.data)


def _in_threads(loop, gaits: Gaits, *rest: int) -> Array:
    p = np.ascontiguousarray(gaits.p.T)
    columns = [np.ascontiguousarray(part, float) for part in gaits[:3]]
    which = np.ascontiguousarray(gaits.which, np.int64)
    count, piece = len(which), _PIECE[True]

    def part(k: int) -> Array:
        end = min(k + piece, count)
        out = np.empty((4, end - k))
        given = [one[k:end].ctypes.data for one in (*columns, which)]
        if not loop(end - k, *given, p.ctypes.data, *rest, out.ctypes.data):
            raise MemoryError
        return out

    starts = range(0, count, piece)
    workers = min(len(os.sched_getaffinity(0)), len(starts))
    if workers < 2:
        return np.concatenate([np.empty((4, 0)), *map(part, starts)], axis=1)
    with ThreadPoolExecutor(workers) as pool:
        return np.concatenate(list(pool.map(part, starts)), axis=1)


@lru_cache
def _table(n: int, straight: bool) -> tuple[Array, tuple[int, int, int]]:
    """What data/sweep_viscous.c calls its table, and the rows of its last three matrices."""
    theta = np.arange(n) * ((1 if straight else 2) * math.pi / n)
    integral, tail, _ = matrices(n, False)
    turning, side_tail, dense = matrices(n, straight)
    phase = 2 * math.pi / n * np.outer(np.arange(n // 2 + 1), np.arange(n))
    forward = np.concatenate([np.cos(phase), -np.sin(phase[1:-1])])
    share = np.full(n, 2.0 / n)
    share[[0, n // 2]] = 1.0 / n
    parts = (
        *(np.sin(theta), np.cos(theta), integral, turning, forward, forward.T * share),
        *(tail, side_tail, dense),
    )
    sizes = len(tail), len(side_tail), len(dense)
    return np.concatenate([part.ravel() for part in parts]), sizes


def source_of(powers: ca.Function) -> str:
    """The C of (phi, p) -> the powers of `speed_powers`, with the loops around it."""
    stages = in_stages(powers, "rr", (1, 0))
    head = f"#define NP {powers.nnz_in(1)}\n#define NK0 {stages.kept[0]}\n"
    lanes, loops = (
        files("rr_opt").joinpath("data", f"sweep_{name}.c").read_text(encoding="utf-8")
        for name in ("lanes", "viscous")
    )
    return head + lanes + stages.source + loops
