"""Steady cycles of many sine gaits as machine code, where a C compiler is available.

Vectorised over some points at a time, on all free processors. For viscous friction the method is
that of `steady_fourier`; other friction is solved as described in newton_cycles.c. Without a
compiler NumPy does all of it.
"""

from __future__ import annotations

import ctypes
import math
from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.mechanics.code_generation import in_stages, source_file
from rr_opt.mechanics.compile_cache import library
from rr_opt.motion.dynamics import Dynamics
from rr_opt.threads import in_threads
from rr_opt.verify.fourier import matrices

_Where = NDArray[np.int_] | tuple[NDArray[np.int_], NDArray[np.int_]]


class Steady(NamedTuple):
    """Steady cycles of G shapes at B periods; every array (G, B).

    speed        along the mean circle, signed along platform 1's mean heading, m/s
    turn         heading gained per period, rad
    peak_torque  largest |torque|, between the samples too, N m
    error        size of the fastest harmonics of the velocity, relative to the speed; inf where
                 no steady cycle was found
    scale        reference for a relative error of the speed, m/s
    """

    speed: Array
    turn: Array
    peak_torque: Array
    error: Array
    scale: Array


class Speeds(NamedTuple):
    """Arrays of one shape; NaN where not converged.

    speed        signed, m/s
    turn         heading gained per period, rad
    peak_torque  N m
    converged    a steady cycle was found and is resolved
    """

    speed: Array
    turn: Array
    peak_torque: Array
    converged: NDArray[np.bool_]

    def keep(self, where: _Where, found: Steady, good: NDArray[np.bool_]) -> None:
        """Write the good results to these places, and NaN to the others."""
        self.converged[where] = good
        for own, values in zip(self[:3], found[:3], strict=True):
            own[where] = np.where(good, values, np.nan)


@lru_cache
def sines(most: int, straight: bool) -> Array:
    """Sines at the phases of `most` samples, and at those needed for their cosines."""
    extra = most // (2 if straight else 4)
    return np.sin(np.arange(most + extra) * ((1 if straight else 2) * math.pi / most))


@lru_cache
def table(n: int, straight: bool) -> tuple[Array, tuple[int, int, int]]:
    """The `Table` of viscous_cycles.c, and the rows of its last three matrices."""
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


_FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fPIC", "-shared")
_PIECE = {True: 4096, False: 64}
"""Points per thread and batch, by whether friction is viscous."""


class Points(NamedTuple):
    """K sine gaits, arrays (K,): amplitude, offset, rad, period, s, and for each the column of its
    robot's parameters."""

    amplitude: Array
    offset: Array
    period: Array
    which: NDArray[np.int_]

    def only(self, own: NDArray[np.int_]) -> Points:
        """A subset of them."""
        amplitude, offset, period, which = self
        return Points(amplitude[own], offset[own], period[own], which[own])


class CompiledCycles:
    """The loops over the points, for the model of one set of effects."""

    most = 256
    """Samples up to which matrices are faster than NumPy's transforms."""

    def __init__(self, made: ctypes.CDLL, viscous: bool) -> None:
        whole, array = ctypes.c_longlong, ctypes.c_void_p
        self._loop = made.rr_viscous if viscous else made.rr_newton
        how = [whole] * 4 if viscous else [whole, whole, ctypes.c_double]
        self._loop.argtypes = [whole, *[array] * 5, ctypes.c_int, *how, array, array]
        self._loop.restype = ctypes.c_int
        self._piece = _PIECE[viscous]

    def viscous(self, points: Points, p: Array, n: int, straight: bool) -> Steady:
        """As `SteadyFourier.cycles`, arrays (K,), from n samples where friction is viscous; p the
        robots' parameters (len, R)."""
        known, sizes = table(n, straight)
        return self._run(points, p, straight, n, *sizes, known)

    def newton(
        self, points: Points, p: Array, first: int, most: int, straight: bool, tolerance: float
    ) -> Steady:
        """The same for any friction, from `first` samples to as many as the results need, or
        `most`; the error is the relative change at the last doublings."""
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

        count = len(columns[0])
        parts = [slice(k, min(k + self._piece, count)) for k in range(0, count, self._piece)]
        speed, turn, torque, error = np.concatenate(in_threads(work, parts), axis=1)
        return Steady(speed, turn, torque, error, np.abs(speed))


def compiled(
    dynamics: Dynamics, powers: ca.Function | None, *, make: bool
) -> CompiledCycles | None:
    """The loops of a model, if compiled before, or compiled now if `make`; None where impossible.

    powers: (phi, p) -> the powers of `steady_fourier`, where the friction is viscous; else the
    loops are around the motion and its slope over v.
    """
    try:
        if powers is None:
            outputs = ["vdot", "jac:vdot:v", "w", "side", "torque"]
            motion = dynamics.motion.factory("tried", dynamics.motion.name_in(), outputs)
            stages, loops = in_stages(motion, "rr", (2, 1, 1, 1, 0)), "newton_cycles.c"
        else:
            stages, loops = in_stages(powers, "rr", (1, 0)), "viscous_cycles.c"
    except NotImplementedError:  # an operation that has no C equivalent
        return None
    sizes = [f"#define NK{k} {kept}\n" for k, kept in enumerate(stages.kept)]
    lanes, points = (source_file("rr_opt.mechanics", name) for name in ("lanes.c", "gait_points.c"))
    head = [f"#define NP {len(dynamics.parameters)}\n", *sizes, lanes, points]
    around = source_file("rr_opt.verify", loops)
    made = library("".join([*head, stages.source, around]), _FLAGS, make=make)
    return None if made is None else CompiledCycles(made, powers is not None)
