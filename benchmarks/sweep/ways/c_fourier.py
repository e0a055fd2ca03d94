"""C by hand, -O3 -march=native: the Fourier steady state, for speed alone; the practical limit."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from functools import lru_cache
from pathlib import Path

import numpy as np

from benchmarks.sweep.case import Array, Work

NAME = "C by hand, Fourier series, speed alone"
SOURCE = Path(__file__).parents[1] / "fourier.c"
BLOCK = 8


@lru_cache
def _compiled(nodes: int):
    compiler = shutil.which("cc")
    if compiler is None:
        raise ImportError("there is no C compiler (cc)")
    flags = ("-O3", "-march=native", "-mprefer-vector-width=512", "-ffast-math", f"-DN={nodes}")
    with tempfile.TemporaryDirectory() as place:
        made = Path(place) / "fourier.so"
        command = [compiler, *flags, "-fPIC", "-shared", "-o", str(made), str(SOURCE), "-lm"]
        subprocess.run(command, check=True)
        library = ctypes.CDLL(str(made))
    library.speeds.argtypes = [ctypes.c_longlong, *[ctypes.c_void_p] * 5]
    library.speeds.restype = None
    return library.speeds


def run(work: Work, steps: int) -> Array:
    """|speed| (K,) with the given number of nodes per period."""
    short = -work.size % BLOCK
    values = (work.amplitude, work.period, work.offset, work.parameters[:12])
    given = [np.ascontiguousarray(np.pad(x, [(0, 0)] * (x.ndim - 1) + [(0, short)], "edge"))
             for x in values]  # fmt: skip
    out = np.empty(work.size + short)
    _compiled(steps)(out.size, *(x.ctypes.data for x in given), out.ctypes.data)
    return out[: work.size]
