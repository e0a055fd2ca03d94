"""x[k + 1] = step(x[k], inputs[k], p), over many steps and for several runs at once."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.mechanics.code_generation import in_stages, source_file
from rr_opt.mechanics.compile_cache import WhenItPays, library

_LOOK, _PAYS = 2_000, 50_000
"""Steps after which the compile cache is looked into, and after which compiling pays."""

_FLAGS = ("-O2", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fPIC", "-shared")


@dataclass(frozen=True)
class Course:
    """A run: where it begins (nx,), the inputs of its steps (steps, ni), and p (np,)."""

    first: Array
    inputs: Array
    p: Array


class _RecurrenceRun(ctypes.Structure):
    """The struct `Run` of the C code."""

    _fields_ = (
        ("steps", ctypes.c_longlong),
        *((name, ctypes.c_void_p) for name in ("first", "inputs", "p", "states")),
    )


class Recurrence:
    """A step that is taken many times: by CasADi's virtual machine or, once it pays and where there
    is a compiler, several runs at once."""

    def __init__(self, step: ca.Function) -> None:
        """step: (x, inputs, p) -> x, an SX function."""
        self._step = step
        self._compiled = WhenItPays(self._code, look=_LOOK, pays=_PAYS)
        self._over = lru_cache(maxsize=64)(step.mapaccum)

    def __call__(self, runs: Sequence[Course]) -> list[Array]:
        """The states (steps, nx) after each step of each run."""
        code = self._compiled.code(sum(len(run.inputs) for run in runs))
        if code is None:
            return [
                np.asarray(self._over(len(run.inputs))(run.first, run.inputs.T, run.p)).T
                for run in runs
            ]
        kept = [
            [np.ascontiguousarray(one, float) for one in (run.first, run.inputs, run.p)]
            for run in runs
        ]
        made = [np.empty((len(run.inputs), run.first.size)) for run in runs]
        every = [
            _RecurrenceRun(len(states), *(one.ctypes.data for one in (*arrays, states)))
            for arrays, states in zip(kept, made, strict=True)
        ]
        code.rr_recur(len(every), (_RecurrenceRun * len(every))(*every))
        return made

    @cached_property
    def _source(self) -> str:
        step = in_stages(self._step, "step", (1, 1, 0))
        sizes = {name: self._step.nnz_in(i) for i, name in enumerate(("NX", "NI", "NP"))}
        defines = [f"#define {name} {n}\n" for name, n in {**sizes, "KEPT": step.kept[0]}.items()]
        lanes, loop = (
            source_file("rr_opt.mechanics", name) for name in ("lanes.c", "recurrence.c")
        )
        return "".join([*defines, lanes, step.source, loop])

    def _code(self, make: bool) -> ctypes.CDLL | None:
        made = library(self._source, _FLAGS, make=make)
        if made is not None:
            made.rr_recur.argtypes = [ctypes.c_longlong, ctypes.c_void_p]
            made.rr_recur.restype = None
        return made
