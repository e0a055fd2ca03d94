"""The steady cycles of `landscape` as machine code, where a C compiler is at hand and it pays.

Some gaits at a time in the processor's vector registers, by the same steps; sines of robots with
viscous friction only.
"""

from __future__ import annotations

import ctypes
from functools import lru_cache
from importlib.resources import files

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.c_stages import in_stages
from rr_opt.physics.machine_code import library

Array = NDArray[np.float64]

_FLAGS = (
    *("-O2", "-march=native", "-mprefer-vector-width=512", "-fno-math-errno"),
    *("-fno-trapping-math", "-fPIC", "-shared"),
)
_PAYS = 500_000
"""Gaits times phases after which to compile takes no longer than has been taken without."""


class LandscapeCode:
    """The loop over the gaits, for one model: compiled once it is used often, or before.

    affine  (phi, dphi, ddphi, p) -> gain on v and shift of vdot, w and side, one after the other
    torque  (v, phi, dphi, ddphi, p) -> torque
    """

    def __init__(self, affine: ca.Function, torque: ca.Function) -> None:
        self._functions, self._asked = (affine, torque), 0
        self._loop: ctypes.CDLL | None = None

    def ready(self, work: int) -> bool:
        """Whether it is compiled, with so much more work (gaits times phases) to come."""
        before, self._asked = self._asked, self._asked + work
        if self._loop is None and (before == 0 or before < _PAYS <= self._asked):
            self._loop = _library(*self._functions, make=self._asked >= _PAYS)
        return self._loop is not None

    def cycles(self, gaits: Array, p: Array, nodes: int) -> tuple[Array, ...]:
        """speed, torque, v, chi, turn and mean as `landscape.Cycles` has them.

        gaits: amplitude, period, offset, (3 or more, K); p: parameters (K, n)
        """
        count = gaits.shape[1]
        amplitude, period, offset = np.ascontiguousarray(gaits[:3], dtype=float)
        which = np.arange(count)
        speed, turn, mean = np.empty(count), np.empty(count), np.empty((4, count))
        v, chi, torque = np.empty((3, nodes, count))
        sine, cosine = _waves(nodes)
        given = (amplitude, offset, period, which, p, sine, cosine, speed, turn, mean)
        pointers = (ctypes.c_void_p(one.ctypes.data) for one in (*given, v, chi, torque))
        sizes = (ctypes.c_longlong(one) for one in (count, nodes))
        if self._loop is None or not self._loop.rr_landscape(*sizes, *pointers):
            raise MemoryError
        return speed, torque, v, chi, turn, mean


@lru_cache
def _waves(nodes: int) -> tuple[Array, Array]:
    """Sine and cosine at the nodes and halfway between them."""
    theta = 2 * np.pi * (np.arange(2 * nodes) / (2 * nodes))
    return np.sin(theta), np.cos(theta)


def _library(affine: ca.Function, torque: ca.Function, *, make: bool) -> ctypes.CDLL | None:
    try:
        lines, load = (
            in_stages(affine, "affine", (1, 1, 1, 0)),
            in_stages(torque, "torque", (1, 1, 1, 1, 0)),
        )
    except NotImplementedError:
        return None
    lanes, points, loop = (
        files("rr_opt").joinpath("data", f"{name}.c").read_text(encoding="utf-8")
        for name in ("lanes", "gait_points", "landscape")
    )
    head = f"#define NP {affine.nnz_in(3)}\n"
    head += f"#define NK_AFFINE {lines.kept[0]}\n#define NK_TORQUE {load.kept[0]}\n"
    parts = [head, lanes, points, lines.source, load.source, loop]
    return library("".join(parts), _FLAGS, make=make)
