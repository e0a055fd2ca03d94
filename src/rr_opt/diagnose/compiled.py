"""Prediction and its derivatives as machine code, where a C compiler is at hand.

CasADi writes the system's step, rates and channels with their derivatives as C; the loop over the
steps is the one below. It computes what `shoot` computes, in the same way, some ten times as fast.
What was compiled is kept in the user's cache folder, by the hash of its source.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from importlib.resources import files

import casadi as ca
import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.physics.machine_code import library

_FREE = ("-fassociative-math", "-freciprocal-math", "-fno-signed-zeros", "-fno-trapping-math")
"""Sums in any order, and one division where there were several: a third faster, and as exact but
for the last digit. Infinities and what is no number stay what they are."""

_FLAGS = ("-O1", "-ftree-vectorize", *_FREE, "-fPIC", "-shared")


class Compiled:
    """The loops over a run, for one system."""

    def __init__(self, made: ctypes.CDLL, sizes: tuple[int, int, int, int]) -> None:
        """sizes: of state, drive, p and channels."""
        whole, array = ctypes.c_longlong, ctypes.c_void_p
        made.rr_predict.argtypes = [whole] * 2 + [array] * 5
        made.rr_slopes.argtypes = [whole] * 5 + [array] * 10
        made.rr_predict.restype = made.rr_slopes.restype = None
        self._library = made
        self._size, _, _, self._channels = sizes

    def predict(
        self, start: Array, inputs: Array, at: Array, each: int, p: Array
    ) -> tuple[Array, Array]:
        """States (size, steps + 1) and what is seen (samples, channels).

        inputs (steps, 1 + 3 drive) of each step; at (drive, samples)
        """
        steps, samples = len(inputs), at.shape[1]
        states = np.empty((steps + 1, self._size))
        states[0] = start
        seen = np.empty((samples, self._channels))
        columns = np.ascontiguousarray(at.T)
        given = [one.ctypes for one in (inputs, columns, p, states, seen)]
        self._library.rr_predict(steps, each, *given)
        return states.T, seen

    def slopes(
        self,
        states: Array,
        inputs: Array,
        at: Array,
        each: int,
        p: Array,
        wanted: Array,
        moved: tuple[Array, Array] | None,
    ) -> tuple[Array, Array]:
        """Derivatives (samples, channels, ...) by what is wanted, and by the start.

        wanted (np, nw); moved: the drive's derivatives (drive, samples, nw), (drive, steps, nw)
        """
        steps, samples, nw = len(inputs), at.shape[1], wanted.shape[1]
        out = np.empty((samples, self._channels, self._size + nw))
        row, column = np.nonzero(wanted)
        drives = [np.ascontiguousarray(one.transpose(1, 0, 2)) for one in moved or ()]
        given = [inputs, np.ascontiguousarray(at.T), p, np.ascontiguousarray(states.T)]
        asked = [row.astype(np.int64), column.astype(np.int64), wanted[row, column]]
        self._library.rr_slopes(
            *(steps, each, nw, len(row), len(drives)),
            *(one.ctypes for one in (*given, *asked)),
            *([one.ctypes for one in drives] or (None, None)),
            out.ctypes,
        )
        return out[:, :, self._size :], out[:, :, : self._size]


def found(source: str, sizes: tuple[int, int, int, int], *, make: bool) -> Compiled | None:
    """A system that was compiled before, or is now; None where that cannot be."""
    made = library(source, _FLAGS, make=make)
    return None if made is None else Compiled(made, sizes)


def source_of(functions: Sequence[ca.Function], sizes: tuple[int, int, int, int]) -> str:
    """The system in C.

    functions  rr_step(state, inputs, p), rr_rates and rr_seen(state, drive, p), the last two with
               their dense Jacobian by all three inputs as a second output
    """
    generator = ca.CodeGenerator("rr", {"with_header": False})
    for function in functions:
        generator.add(function)
    work = [max(f.sz_w() for f in functions), max(f.sz_iw() for f in functions)]
    names = ("NX", "ND", "NP", "NY", "NW_WORK", "NI_WORK")
    head = "\n".join(f"#define {name} {n}" for name, n in zip(names, [*sizes, *work], strict=True))
    loop = files("rr_opt").joinpath("data", "diagnose_loop.c").read_text(encoding="utf-8")
    return f"{generator.dump()}\n{head}\n{loop}"
