"""Prediction and its derivatives as machine code, where a C compiler is at hand.

CasADi's step, rates and channels become C for several runs at a time, one in each lane of the
processor's vector registers; the loops over the steps are those of diagnose_lanes.c. What was
compiled is kept in the user's cache folder, by the hash of its source.
"""

from __future__ import annotations

import ctypes
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import casadi as ca
import numpy as np

from rr_opt.array import Array, Indices
from rr_opt.mechanics.code_generation import in_stages, source_file
from rr_opt.mechanics.compile_cache import library
from rr_opt.threads import in_threads

_FLAGS = (
    *("-O2", "-march=native", "-fno-math-errno", "-fno-trapping-math"),
    *("-ffp-contract=fast", "-fPIC", "-shared"),
)

FINE = 4
"""From this many steps between two samples, the midpoint slope is enough for derivatives."""

_WORTH = 1000
"""Steps below which starting a thread takes longer than the work itself."""


class _CompiledRun(ctypes.Structure):
    """The struct `Run` of the C code."""

    _fields_ = (
        ("steps", ctypes.c_longlong),
        *(
            (name, ctypes.c_void_p)
            for name in (
                *("inputs", "at", "p", "states", "seen", "value"),
                *("moved_at", "moved", "data", "weight", "more", "gram", "end"),
            )
        ),
    )


@dataclass(frozen=True)
class Rows:
    """Input to the sums over derivatives, of one run; arrays are row-major.

    inputs, at, each, p, states  as `Compiled.predict` takes and gives them
    wanted  (np, nq) dp/dq
    moved   d(drive)/dq at the samples (drive, samples, k) and at the nodes (drive, 3, steps, k), of
            those q that move it, and which they are (k,)
    data, weight  (samples, channels) what was recorded, and 1/sigma, 0 where nothing was
    more    (samples, channels, k) further columns
    """

    inputs: Array
    at: Array
    each: int
    p: Array
    states: Array
    wanted: Array
    moved: tuple[Array, Array, Indices] | None
    data: Array
    weight: Array
    more: Array | None = None


class Compiled:
    """The loops over runs, for one system."""

    def __init__(self, made: ctypes.CDLL, size: int, channels: int) -> None:
        """size: of the state."""
        whole, array = ctypes.c_longlong, ctypes.c_void_p
        made.rr_predict.argtypes = [whole, array, whole]
        made.rr_predict.restype = None
        made.rr_grams.argtypes = [whole, array, *[whole] * 5, *[array] * 3]
        made.rr_grams.restype = ctypes.c_int
        made.rr_lanes.restype = whole
        self._library, self._lanes = made, made.rr_lanes()
        self._size, self._channels = size, channels

    def predict(
        self, runs: Sequence[tuple[Array, Array, Array, int, Array]]
    ) -> list[tuple[Array, Array]]:
        """States (size, steps + 1) and outputs (samples, channels) of each run.

        runs  (start, inputs (steps, 1 + 3 drive) of each step, at (drive, samples), steps between
              two samples, p)
        """
        held, made = [], []
        for start, inputs, at, _, p in runs:
            states = np.empty((len(inputs) + 1, self._size))
            states[0] = start
            seen = np.empty((at.shape[1], self._channels))
            held.append(
                _Held(steps=len(inputs), inputs=inputs, at=at.T, p=p, states=states, seen=seen)
            )
            made.append((states.T, seen))

        def work(few: _Few) -> None:
            self._library.rr_predict(len(few.held), _array(few.held), few.each)

        self._at_once(work, held, [each for *_, each, _ in runs])
        return made

    def grams(self, runs: Sequence[Rows]) -> list[tuple[Array, Array]]:
        """J'J of each run, (n, n), with J = [d/dstart | d/dq | more | predicted - recorded] in
        sigmas; and the derivatives of its last state (size, size + nq) by start and q.

        Raises ValueError if the runs differ in their number of q or further columns.
        """
        first = runs[0]
        shapes = {(run.wanted.shape, run.more is None or run.more.shape[2]) for run in runs}
        if len(shapes) > 1:
            raise ValueError(f"Read columns of {sorted(map(str, shapes))}. Expected all alike.")
        touched = np.any([run.wanted != 0 for run in runs], axis=0)
        row, column = (index.astype(np.int64) for index in np.nonzero(touched))
        first_of = np.searchsorted(row, np.arange(len(first.wanted) + 1)).astype(np.int64)
        nq, extras = first.wanted.shape[1], 0 if first.more is None else first.more.shape[2]
        moving = _moving(runs)
        n = self._size + nq + extras + 1
        drive = first.at.shape[0]
        out = [(np.empty((n, n)), np.empty((self._size, self._size + nq))) for _ in runs]
        held = []
        for run, (gram, end) in zip(runs, out, strict=True):
            moved = {}
            if moving.size:
                at = np.zeros((len(run.data), drive, moving.size))
                nodes = np.zeros((len(run.inputs), 3, drive, moving.size))
                if run.moved:
                    own = np.searchsorted(moving, run.moved[2])
                    at[:, :, own] = run.moved[0].transpose(1, 0, 2)
                    nodes[:, :, :, own] = run.moved[1].transpose(2, 1, 0, 3)
                moved = {"moved_at": at, "moved": nodes}
            if extras:
                moved["more"] = run.more
            held.append(
                _Held(
                    steps=len(run.inputs),
                    inputs=run.inputs,
                    at=run.at.T,
                    p=run.p,
                    states=run.states.T,
                    value=run.wanted[row, column],
                    data=run.data,
                    weight=run.weight,
                    gram=gram,
                    end=end,
                    **moved,
                )
            )

        def work(few: _Few) -> None:
            done = self._library.rr_grams(
                *(len(few.held), _array(few.held), few.each),
                *(nq, len(row), len(moving), extras),
                *(one.ctypes for one in (first_of, column, moving)),
            )
            if not done:
                raise MemoryError

        self._at_once(work, held, [run.each for run in runs])
        return out

    def _at_once(
        self, work: Callable[[_Few], None], held: Sequence[_Held], each: Sequence[int]
    ) -> None:
        """One run per lane at a time, grouped by equal steps per sample and similar length; in
        threads where that pays."""
        ordered = sorted(zip(each, held, strict=True), key=lambda one: (one[0], one[1].run.steps))
        groups = []
        for count, alike in itertools.groupby(ordered, lambda one: one[0]):
            runs = [run for _, run in alike]
            lanes = range(0, len(runs), self._lanes)
            groups += [_Few(count, runs[k : k + self._lanes]) for k in lanes]
        if max((one.run.steps for one in held), default=0) < _WORTH:
            for few in groups:
                work(few)
        else:
            in_threads(work, groups)


def _moving(runs: Sequence[Rows]) -> Indices:
    """The columns of q that move the drive of any run (k,)."""
    moving = [run.moved[2] for run in runs if run.moved]
    return np.unique(np.concatenate([np.zeros(0, np.int64), *moving]).astype(np.int64))


class _Held:
    """A run as the C takes it, and the arrays that it points to, kept alive."""

    def __init__(self, *, steps: int, **arrays: Array) -> None:
        if steps < 1:
            raise ValueError(f"Read a run of {steps} steps. Expected 1 or more.")
        self.arrays = {name: np.ascontiguousarray(one, float) for name, one in arrays.items()}
        # Output arrays must be the caller's own, not copies.
        assert all(
            self.arrays[name] is arrays[name] for name in ("seen", "gram", "end") if name in arrays
        )
        self.run = _CompiledRun(
            steps=steps, **{name: one.ctypes.data for name, one in self.arrays.items()}
        )


class _Few(NamedTuple):
    """Runs processed side by side, and their steps between two samples."""

    each: int
    held: Sequence[_Held]


def _array(held: Sequence[_Held]) -> ctypes.Array:
    return (_CompiledRun * len(held))(*(one.run for one in held))


def found(source: str, size: int, channels: int, *, make: bool) -> Compiled | None:
    """The compiled system, from the cache or compiled now; None if neither is possible."""
    made = library(source, _FLAGS, make=make)
    return None if made is None else Compiled(made, size, channels)


def source_of(step: ca.Function, rates: ca.Function, seen: ca.Function, *, stiff: bool) -> str:
    """A system in C.

    step(state, inputs, p) is the end of a step; rates and seen(state, drive, p)
    Raises NotImplementedError for an operation without a C equivalent.
    """
    state, drive, p = (rates.numel_in(i) for i in range(3))
    head = {"NX": state, "ND": drive, "NP": p, "NY": seen.numel_out(0)}
    parts = [in_stages(step, "step", (1, 1, 0), "ALONE")]
    head |= {"K_STEP": parts[0].kept[0], "FINE": FINE}
    tables = []
    for name, letter, function in (("rates", "R", rates), ("seen", "S", seen)):
        inputs = function.sx_in()
        value = ca.densify(function(*inputs))
        by = ca.jacobian(value, ca.vertcat(*inputs))
        rows, columns = (np.array(index, int) for index in by.sparsity().get_triplet())
        edges = np.searchsorted(columns, [state, state + drive])
        sizes = np.diff([0, *edges, len(columns)])
        head |= {f"{letter}{key}": int(n) for key, n in zip("XDP", sizes, strict=True)}
        tables += [_table(f"{name.upper()}_ROW", rows), _table(f"{name.upper()}_COLUMN", columns)]
        both = ca.Function(f"{name}_by", inputs, ca.cse([value, by]))
        parts.append(in_stages(both, name, (1, 1, 0), "ALONE"))
        head[f"K_{name.upper()}"] = parts[-1].kept[0]
    defines = [f"#define {name} {number}\n" for name, number in head.items()]
    lanes = source_file("rr_opt.mechanics", "lanes.c")
    loops = source_file("rr_opt.sysid", "diagnose_lanes.c")
    sources = [part.source for part in parts]
    return "".join([*defines, "#define STIFF\n" * stiff, lanes, *sources, *tables, loops])


def _table(name: str, numbers: Array) -> str:
    listed = ", ".join(str(n) for n in numbers) or "0"
    return f"static const int {name}[] = {{{listed}}};\n"
