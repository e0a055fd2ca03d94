"""Steady cycles of many sine gaits as machine code, where a C compiler is at hand.

Some points at a time in the processor's vector registers, on all processors that are free. For
viscous friction the method is that of `steady_fourier`; other friction is solved as
data/sweep_newton.c says. Where nothing can be compiled, NumPy does all of it.
"""

from __future__ import annotations

import ctypes
from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.dynamics import Dynamics
from rr_opt.physics.machine_code import library
from rr_opt.verify.compiled_source import newton_source, viscous_source
from rr_opt.verify.compiled_table import sines, table
from rr_opt.verify.in_pieces import in_pieces
from rr_opt.verify.steady import Steady

Array = NDArray[np.float64]

_FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fPIC", "-shared")
_PIECE = {True: 4096, False: 64}
"""Points that a thread takes at a time, where friction is viscous (True) or not."""


class Points(NamedTuple):
    """K sine gaits, arrays (K,): amplitude, offset, rad, period, s, and which column of the robots'
    parameters is that of each."""

    amplitude: Array
    offset: Array
    period: Array
    which: NDArray[np.int_]

    def only(self, own: NDArray[np.int_]) -> Points:
        """Some of them."""
        amplitude, offset, period, which = self
        return Points(amplitude[own], offset[own], period[own], which[own])


class CompiledCycles:
    """The loops over the points, for the model of one set of effects."""

    most = 256
    """Samples up to which matrices are faster than the transforms that NumPy has."""

    def __init__(self, made: ctypes.CDLL, viscous: bool) -> None:
        whole, array = ctypes.c_longlong, ctypes.c_void_p
        self._loop = made.rr_viscous if viscous else made.rr_newton
        how = [whole] * 4 if viscous else [whole, whole, ctypes.c_double]
        self._loop.argtypes = [whole, *[array] * 5, ctypes.c_int, *how, array, array]
        self._loop.restype = ctypes.c_int
        self._piece = _PIECE[viscous]

    def viscous(self, points: Points, p: Array, n: int, straight: bool) -> Steady:
        """What `SteadyFourier.cycles` tells, arrays (K,), from n samples where friction is
        viscous; p the robots' parameters (len, R)."""
        known, sizes = table(n, straight)
        return self._run(points, p, straight, n, *sizes, known)

    def newton(
        self, points: Points, p: Array, first: int, most: int, straight: bool, tolerance: float
    ) -> Steady:
        """The same for any friction, from `first` samples to as many as the results need, or
        `most`; the error is what the last doublings changed, relative."""
        known = sines(most, straight)
        return self._run(points, p, straight, first, most, tolerance, known)

    def _run(self, points: Points, p: Array, straight: bool, *how: float | Array) -> Steady:
        columns = [np.ascontiguousarray(part, float) for part in points[:3]]
        columns.append(np.ascontiguousarray(points.which, np.int64))
        robots = np.ascontiguousarray(p.T)
        rest = [one.ctypes.data if isinstance(one, np.ndarray) else one for one in how]

        def work(part: slice) -> Array:
            out = np.empty((4, part.stop - part.start))
            given = [column[part].ctypes.data for column in columns]
            place = (out.shape[1], *given, robots.ctypes.data, int(straight))
            if not self._loop(*place, *rest, out.ctypes.data):
                raise MemoryError
            return out

        speed, turn, torque, error = in_pieces(work, len(columns[0]), self._piece)
        return Steady(speed, turn, torque, error, np.abs(speed))


def compiled(
    dynamics: Dynamics, powers: ca.Function | None, *, make: bool
) -> CompiledCycles | None:
    """The loops of a model that was compiled before, or is now if `make`; None where that cannot
    be. powers: of `speed_powers`, where the friction is viscous."""
    try:
        source = newton_source(dynamics) if powers is None else viscous_source(powers)
    except NotImplementedError:
        return None
    made = library(source, _FLAGS, make=make)
    return None if made is None else CompiledCycles(made, powers is not None)
