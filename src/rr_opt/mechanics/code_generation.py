"""CasADi functions as machine code: C source, the compiler, and the cache of what was compiled.

C source of a derived CasADi function for several points at once, in stages.

CasADi's own C computes everything of one point. Here each value is a vector `V` of some points
(see data/lanes.c), and what depends on the first inputs alone is computed by a function of
its own: of a sweep on the robot once for a whole gait, and on the posture once for all tries of the
speed; of a diagnosis on the parameters once for all steps of some runs.

C source made into a library of this machine, where a C compiler is at hand.

What was compiled is kept in the user's cache folder, by the hash of its source.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray


def inverted(A: ca.SX) -> ca.SX:
    """A^-1 of a regular matrix (n, n), for n up to 4 or so."""
    n = A.size1()
    if n == 1:
        return 1 / A
    cofactors = [
        [
            (-1) ** (i + j)
            * ca.det(A[[r for r in range(n) if r != j], [c for c in range(n) if c != i]])
            for j in range(n)
        ]
        for i in range(n)
    ]
    return ca.vertcat(*(ca.horzcat(*row) for row in cofactors)) / ca.det(A)


_BINARY = {
    ca.OP_ADD: "{} + {}",
    ca.OP_SUB: "{} - {}",
    ca.OP_MUL: "{} * {}",
    ca.OP_DIV: "{} * {}",
    ca.OP_POW: "v_pow({}, {})",
    ca.OP_CONSTPOW: "v_pow({}, {})",
    ca.OP_ATAN2: "v_atan2({}, {})",
    ca.OP_FMIN: "v_min({}, {})",
    ca.OP_FMAX: "v_max({}, {})",
    ca.OP_LT: "pick({} < {}, all(1.0), all(0.0))",
    ca.OP_LE: "pick({} <= {}, all(1.0), all(0.0))",
    ca.OP_IF_ELSE_ZERO: "pick({} != all(0.0), {}, all(0.0))",
}
_UNARY = {
    ca.OP_ASSIGN: "{}",
    ca.OP_NEG: "-{}",
    ca.OP_SQRT: "v_sqrt({})",
    ca.OP_SQ: "{0} * {0}",
    ca.OP_SIN: "v_sin({})",
    ca.OP_COS: "v_cos({})",
    ca.OP_TAN: "v_tan({})",
    ca.OP_TANH: "v_tanh({})",
    ca.OP_EXP: "v_exp({})",
    ca.OP_LOG: "v_log({})",
    ca.OP_FABS: "v_abs({})",
    ca.OP_SIGN: "v_sign({})",
    ca.OP_INV: "1.0 / {}",
    ca.OP_NOT: "pick({} == all(0.0), all(1.0), all(0.0))",
    ca.OP_TWICE: "{0} + {0}",
}


@dataclass
class _Value:
    """One assignment: its right side with a hole for each of the values it needs.

    A constant has stage -1, and stands wherever it is needed.
    """

    text: str
    needs: tuple[int, ...]
    stage: int
    later: bool = field(default=False)
    """Whether a later stage needs it."""


@dataclass(frozen=True)
class Stages:
    """source: functions NAME_0 .. NAME_k; kept: how many V each but the last hands on.

    NAME_i(const V* x, const V* kept_0, .. const V* kept_(i-1), V* out): x are the inputs of that
    stage, one after the other; out is what is kept, and the function's outputs at the last.
    """

    source: str
    kept: tuple[int, ...]


def in_stages(
    function: ca.Function, name: str, stages: Sequence[int], how: str = "INLINE"
) -> Stages:
    """An SX function whose i-th input comes in at stage stages[i] (0, 1, ..).

    how  INLINE or ALONE, of data/lanes.c: copied to where it is called, or called

    Raises NotImplementedError for an operation that has no C here.
    """
    values, outputs = _values(function, stages)
    last = max(stages)
    for value in values:
        for need in value.needs:
            values[need].later |= 0 <= values[need].stage < value.stage
    for k in outputs:
        values[k].later |= 0 <= values[k].stage < last
    place = [
        {k: at for at, k in enumerate(k for k, v in enumerate(values) if v.stage == s and v.later)}
        for s in range(last)
    ]
    parts = []
    for stage in range(last + 1):
        earlier = "".join(f", const V* restrict kept_{s}" for s in range(stage))
        parts.append(f"{how} void {name}_{stage}(const V* restrict x{earlier}, V* restrict out) {{")
        parts += [f"  (void)kept_{s};" for s in range(stage)]

        def named(k: int, stage: int = stage) -> str:
            s = values[k].stage
            if s < 0:
                return values[k].text
            return f"a{k}" if s == stage else f"kept_{s}[{place[s][k]}]"

        for k, value in enumerate(values):
            if value.stage == stage:
                parts.append(f"  const V a{k} = {value.text.format(*map(named, value.needs))};")
        if stage == last:
            parts += [f"  out[{at}] = {named(k)};" for at, k in enumerate(outputs)]
        else:
            parts += [f"  out[{at}] = a{k};" for k, at in place[stage].items()]
        parts.append("}")
    return Stages("\n".join(parts) + "\n", tuple(len(kept) for kept in place))


def _values(function: ca.Function, stages: Sequence[int]) -> tuple[list[_Value], list[int]]:
    """Every value of the function, assigned once, and which of them are its outputs."""
    starts: dict[int, int] = {}
    sizes = [0] * (max(stages) + 1)
    for i, stage in enumerate(stages):
        starts[i] = sizes[stage]
        sizes[stage] += function.nnz_in(i)
    register: dict[int, int] = {}
    inverse: dict[int, int] = {}
    values: list[_Value] = []
    outputs = [-1] * sum(function.nnz_out(i) for i in range(function.n_out()))
    first_out = [sum(function.nnz_out(j) for j in range(i)) for i in range(function.n_out())]
    for k in range(function.n_instructions()):
        code = function.instruction_id(k)
        out, args = function.instruction_output(k), function.instruction_input(k)
        if code == ca.OP_OUTPUT:
            outputs[first_out[out[0]] + out[1]] = register[args[0]]
            continue
        if code == ca.OP_INPUT:
            value = _Value(f"x[{starts[args[0]] + args[1]}]", (), stages[args[0]])
        elif code == ca.OP_CONST:
            value = _Value(f"all({function.instruction_constant(k)!r})", (), -1)
        elif code in _BINARY or code in _UNARY:
            text = _BINARY.get(code) or _UNARY[code]
            needs = tuple(register[a] for a in args[: 2 if code in _BINARY else 1])
            if code == ca.OP_DIV:
                # Many divide by the same: once inverted, and then multiplied by.
                divisor = needs[1]
                if divisor not in inverse:
                    inverse[divisor] = len(values)
                    stage = max(0, values[divisor].stage)
                    values.append(_Value("1.0 / {}", (divisor,), stage))
                needs = (needs[0], inverse[divisor])
            value = _Value(text, needs, max(0, *(values[need].stage for need in needs)))
        else:
            raise NotImplementedError(f"operation {code} of {function.name()} has no C here")
        register[out[0]] = len(values)
        values.append(value)
    return values, outputs


_SECONDS = 60
"""A compiler that takes longer is not waited for."""

_NATIVE = "-march=native"


def library(source: str, flags: tuple[str, ...], *, make: bool) -> ctypes.CDLL | None:
    """What was compiled before, or is now if `make`; None where that cannot be."""
    compiler = shutil.which(os.environ.get("CC", "cc"))
    folder = _cache()
    if not compiler or not folder:
        return None
    # A home may be shared by machines; what one of them calls native another may not have.
    machine = (_processor(),) if _NATIVE in flags else ()
    key = hashlib.sha256("\n".join((source, compiler, *flags, *machine)).encode()).hexdigest()[:32]
    made = folder / f"{key}.so"
    try:
        if not made.exists():
            if not make:
                return None
            _compile(compiler, source, flags, made)
        return ctypes.CDLL(str(made))
    except (OSError, subprocess.SubprocessError):
        return None


def _compile(compiler: str, source: str, flags: tuple[str, ...], library: Path) -> None:
    with tempfile.TemporaryDirectory(dir=library.parent) as place:
        code, made = Path(place) / "system.c", Path(place) / "system.so"
        code.write_text(source, encoding="utf-8")
        subprocess.run(
            [compiler, *flags, "-o", str(made), str(code), "-lm"],
            check=True,
            capture_output=True,
            timeout=_SECONDS,
        )
        made.replace(library)


@lru_cache
def _processor() -> str:
    """What tells one kind of processor from another."""
    told = {"vendor_id", "model name", "flags", "Features", "CPU part"}
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    own = sorted({line for line in lines if line.split(":")[0].strip() in told})
    return "\n".join((platform.machine(), platform.processor(), *own))


def _cache() -> Path | None:
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(base) / "rr-opt"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        return None
    # Code that another user could have put there is not run.
    mine = not hasattr(os, "getuid") or folder.stat().st_uid == os.getuid()
    return folder if mine and os.access(folder, os.W_OK) else None


def externals(
    name: str, functions: Iterable[ca.Function], flags: tuple[str, ...], *, make: bool
) -> tuple[ca.Function, ...] | None:
    """The same functions, if their code was compiled before, or is now; see `library`.

    name  of the code as a whole
    """
    generator = ca.CodeGenerator(name, {"with_header": False})
    functions = tuple(functions)
    for function in functions:
        generator.add(function)
    made = library(generator.dump(), flags, make=make)
    if made is None:
        return None
    return tuple(ca.external(function.name(), made._name) for function in functions)


_FLAGS = ("-O1", "-ffp-contract=off", "-fPIC", "-shared")
"""No operation is done otherwise than by CasADi's virtual machine: the numbers are the same."""


class OftenUsed:
    """A function as machine code from its `pays`-th call on; if it was before, from its `few`-th.

    few, pays  calls that take as long as to look for what was compiled before, and as to compile
    """

    def __init__(self, function: ca.Function, few: int, pays: int) -> None:
        self._function, self._left = function, {few: False, pays: True}
        self._calls = 0

    def __call__(self, *args: ArrayLike) -> NDArray[np.float64]:
        """Evaluate it, a function of one output."""
        make = self._left.pop(self._calls, None)
        if make is not None:
            name = self._function.name()
            compiled = externals(name, (self._function,), _FLAGS, make=make)
            if compiled:
                self._function, self._left = compiled[0], {}
        self._calls += 1
        return np.asarray(self._function(*args))
