"""Prediction and its derivatives as machine code, where a C compiler is at hand.

CasADi's step, rates and channels become C for several runs at a time, one in each lane of the
processor's vector registers; the loops over the steps are those of diagnose_lanes.c. What was
compiled is kept in the user's cache folder, by the hash of its source.
"""

from __future__ import annotations

import ctypes
import itertools
from collections.abc import Callable, Sequence
from typing import NamedTuple

import casadi as ca
import numpy as np

from rr_opt.array import Array, Indices
from rr_opt.mechanics.code_generation import in_stages, source_file
from rr_opt.mechanics.compile_cache import library
from rr_opt.sysid.paths import Sought
from rr_opt.threads import in_threads

_FLAGS = (
    *("-O2", "-march=native", "-fno-math-errno", "-fno-trapping-math"),
    *("-ffp-contract=fast", "-fPIC", "-shared"),
)

_LARGE, _EASY = 1_000_000, '#pragma GCC optimize ("Og")\n'
"""Characters of C beyond which optimising takes longer than it saves: allocating registers for
30,000 assignments in a row takes ten seconds, for a system that a diagnosis uses a few times."""

_WORTH = 100
"""Steps below which starting a thread takes longer than the work itself."""

_SIDE_BY_SIDE = 16
"""Few runs are linearised in pieces, up to so many in all: their states are known."""


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

    def grams(self, runs: Sequence[Sought]) -> list[tuple[Array, Array]]:
        """J'J of each run, (n, n), with J = [d/dstart | d/dq | more | predicted - recorded] in
        sigmas; and the derivatives of its last state (size, size + nq) by start and q.

        Raises ValueError if the runs differ in their number of q or further columns.
        """
        cut = [run.pieces(_SIDE_BY_SIDE // len(runs)) for run in runs]
        made = iter(self._grams([piece for pieces in cut for piece in pieces]))
        return [_joined([next(made) for _ in pieces]) for pieces in cut]

    def _grams(self, runs: Sequence[Sought]) -> list[tuple[Array, Array]]:
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
        drive = first.path.at.shape[0]
        out = [(np.empty((n, n)), np.empty((self._size, self._size + nq))) for _ in runs]
        held = []
        for run, (gram, end) in zip(runs, out, strict=True):
            path, by, more = run.path, run.drive_by, {}
            if moving.size:
                at = np.zeros((path.at.shape[1], drive, moving.size))
                middle = np.zeros((path.h.size, drive, moving.size))
                if by:
                    own = np.searchsorted(moving, by.columns)
                    at[:, :, own] = by.at.transpose(1, 0, 2)
                    middle[:, :, own] = by.middle.transpose(1, 0, 2)
                more |= {"moved_at": at, "moved": middle}
            if run.more is not None:
                more["more"] = run.more
            held.append(
                _Held(
                    steps=path.h.size,
                    inputs=path.inputs,
                    at=path.at.T,
                    p=run.p,
                    states=run.made.states.T,
                    value=run.wanted[row, column],
                    data=run.recorded.values,
                    weight=run.recorded.weight,
                    gram=gram,
                    end=end,
                    **more,
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

        self._at_once(work, held, [run.path.each for run in runs])
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


def _joined(pieces: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
    """The sum of a run's pieces, by what the first starts from; and the run's end."""
    total, carried = pieces[0]
    size, width = carried.shape
    for gram, end in pieces[1:]:
        by = np.eye(len(gram))
        # Where a prediction has left the numbers there is nothing to carry on.
        by[:size, :width] = carried if gram[:size].any() else 0.0
        total = total + by.T @ gram @ by
        carried = end[:, :size] @ carried + np.pad(end[:, size:], ((0, 0), (size, 0)))
    return total, carried


def _moving(runs: Sequence[Sought]) -> Indices:
    """The columns of q that move the drive of any run (k,)."""
    moving = [run.drive_by.columns for run in runs if run.drive_by]
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


def found(
    source: str | Callable[[], str], size: int, channels: int, *, make: bool, key: str = ""
) -> Compiled | None:
    """The compiled system, from the cache or compiled now; None if neither is possible."""
    made = library(source, _FLAGS, make=make, key=key)
    return None if made is None else Compiled(made, size, channels)


def source_of(step: ca.Function, rates: ca.Function, seen: ca.Function, *, stiff: bool) -> str:
    """A system in C.

    step(state, inputs, p) is the end of a step; rates and seen(state, drive, p)
    Raises NotImplementedError for an operation without a C equivalent.
    """
    state, drive, p = (rates.numel_in(i) for i in range(3))
    outputs = seen.numel_out(0)
    x, u, q = rates.sx_in()
    h = ca.SX.sym("h")
    slope, value = ca.densify(rates(x, u, q)), ca.densify(seen(x, u, q))
    P, Q = transition(ca.jacobian(slope, x), h, stiff=stiff)
    tangent = [P, Q, ca.jacobian(slope, u), ca.jacobian(slope, q)]
    by = [ca.jacobian(value, one) for one in (x, u, q)]
    head = {"NX": state, "ND": drive, "NP": p, "NY": outputs, "SEEN": sum(one.nnz() for one in by)}
    head |= {f"TANGENT_{key}": one.nnz() for key, one in zip("PQRS", tangent, strict=True)}
    head |= {f"SEEN_{key}": one.nnz() for key, one in zip("XRS", by, strict=True)}
    head |= {"TANGENT": sum(one.nnz() for one in tangent)}
    made = {
        "step": step,
        "tangent": ca.Function("tangent", [ca.vertcat(x, u, h), q], _nonzeros(tangent)),
        "seen": ca.Function("seen", [ca.vertcat(x, u), q], _nonzeros([value, *by])),
    }
    parts = []
    for name, function in made.items():
        stages = [1] * (function.n_in() - 1) + [0]
        parts.append(in_stages(function, name, stages, "ALONE"))
        head[f"K_{name.upper()}"] = parts[-1].kept[0]
    by_state = [int(by[0][i, :].nnz() > 0) for i in range(outputs)]
    tables = [
        *_places("TANGENT", tangent[2:]),
        *_places("SEEN", by[1:]),
        _table("BY_STATE", by_state),
        *(_times(*one) for one in (("p", P), ("q", Q), ("seen", by[0]))),
    ]
    defines = [f"#define {name} {number}\n" for name, number in head.items()]
    lanes = source_file("rr_opt.mechanics", "lanes.c")
    loops = source_file("rr_opt.sysid", "diagnose_lanes.c")
    text = "".join([*defines, lanes, *(part.source for part in parts), *tables, loops])
    return _EASY + text if len(text) > _LARGE else text


def transition(by_state: ca.SX, h: ca.SX, *, stiff: bool) -> tuple[ca.SX, ca.SX]:
    """P and Q of a step along which the derivatives of the rates are constant: x moves on by
    P dx + Q f, with a constant further rate f.

    That is the midpoint rule; with stiff states exp(h by_state) is replaced by its Pade approximant
    (1 + z/3)/(1 - 2z/3 + z^2/6), which damps them.
    """
    eye, z = ca.SX.eye(by_state.shape[0]), h * by_state
    if not stiff:
        return eye + z + z @ z / 2, h * (eye + z / 2)
    n = by_state.shape[0]
    right = ca.horzcat(eye + z / 3, h * (eye - z / 6))
    both = _divided(eye - 2 / 3 * z + z @ z / 6, right)
    return both[:, :n], both[:, n:]


def _divided(left: ca.SX, right: ca.SX) -> ca.SX:
    """left^-1 right. No pivots are sought: what settles makes the diagonal large, the rest is near
    1."""
    both = ca.horzcat(left, right)
    for k in range(left.shape[0]):
        both[k, :] = both[k, :] / both[k, k]
        for i in range(left.shape[0]):
            if i != k and both[i, k].nnz():
                both[i, :] = both[i, :] - both[i, k] * both[k, :]
        both = ca.sparsify(both)
    return both[:, left.shape[1] :]


def _nonzeros(matrices: Sequence[ca.SX]) -> list[ca.SX]:
    return [ca.cse(ca.vertcat(*(one.nz[:] for one in matrices)))]


def _places(name: str, matrices: Sequence[ca.SX]) -> list[str]:
    """Tables of the rows and the columns of nonzeros."""
    at = [one.sparsity().get_triplet() for one in matrices]
    both = (("ROW", np.hstack([rows for rows, _ in at])), ("COLUMN", np.hstack([c for _, c in at])))
    return [_table(f"{name}_{key}", numbers) for key, numbers in both]


def _times(name: str, matrix: ca.SX) -> str:
    """NAME_times(by, x, out): adds the product of a matrix, given its nonzeros, with a vector."""
    rows, columns = matrix.sparsity().get_triplet()
    terms = enumerate(zip(rows, columns, strict=True))
    lines = [f"  out[{i}] += by[{k}] * x[{j}];\n" for k, (i, j) in terms]
    return f"INLINE void {name}_times(const V* by, const V* x, V* out) {{\n{''.join(lines)}}}\n"


def _table(name: str, numbers: Array | Sequence[int]) -> str:
    listed = ", ".join(str(int(n)) for n in numbers) or "0"
    return f"static const int {name}[] = {{{listed}}};\n"
