"""C source of a CasADi function for several points at once, in stages.

CasADi's own C evaluates one point. Here each value is a vector `V` of points, one in each lane of a
vector register (lanes.c), and what depends on the first inputs alone is computed by a function of
its own: in a sweep what the robot determines once for a whole gait, and what the posture determines
once for all iterates of the speed; in a diagnosis what the parameters determine once for all steps.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.resources import files
from itertools import accumulate
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

_BINARY = {
    ca.OP_ADD: (np.add, "{} + {}"),
    ca.OP_SUB: (np.subtract, "{} - {}"),
    ca.OP_MUL: (np.multiply, "{} * {}"),
    ca.OP_DIV: (np.divide, "{} * {}"),
    ca.OP_POW: (np.power, "v_pow({}, {})"),
    ca.OP_CONSTPOW: (np.power, "v_pow({}, {})"),
    ca.OP_ATAN2: (np.arctan2, "v_atan2({}, {})"),
    ca.OP_FMIN: (np.minimum, "v_min({}, {})"),
    ca.OP_FMAX: (np.maximum, "v_max({}, {})"),
    ca.OP_LT: (np.less, "pick({} < {}, all(1.0), all(0.0))"),
    ca.OP_LE: (np.less_equal, "pick({} <= {}, all(1.0), all(0.0))"),
    ca.OP_AND: (np.logical_and, "pick({} != all(0.0), {}, all(0.0))"),
    ca.OP_OR: (np.logical_or, "pick({0} != all(0.0), {0}, {1})"),
    ca.OP_IF_ELSE_ZERO: (
        lambda condition, x: np.where(condition, x, 0.0),
        "pick({} != all(0.0), {}, all(0.0))",
    ),
}
_UNARY = {
    ca.OP_ASSIGN: (np.positive, "{}"),
    ca.OP_NEG: (np.negative, "-{}"),
    ca.OP_SQRT: (np.sqrt, "v_sqrt({})"),
    ca.OP_SQ: (np.square, "{0} * {0}"),
    ca.OP_SIN: (np.sin, "v_sin({})"),
    ca.OP_COS: (np.cos, "v_cos({})"),
    ca.OP_TAN: (np.tan, "v_tan({})"),
    ca.OP_TANH: (np.tanh, "v_tanh({})"),
    ca.OP_EXP: (np.exp, "v_exp({})"),
    ca.OP_LOG: (np.log, "v_log({})"),
    ca.OP_FABS: (np.abs, "v_abs({})"),
    ca.OP_SIGN: (np.sign, "v_sign({})"),
    ca.OP_INV: (np.reciprocal, "1.0 / {}"),
    ca.OP_NOT: (np.logical_not, "pick({} == all(0.0), all(1.0), all(0.0))"),
    ca.OP_TWICE: (lambda x: x + x, "{0} + {0}"),
}
"""Each operation over arrays, and in C."""


@dataclass
class _Value:
    """One assignment: its right side with a hole for each of the values it needs.

    A constant has stage -1 and is written wherever it is needed. `kept`: a later stage needs it.
    """

    text: str
    needs: tuple[int, ...]
    stage: int
    kept: bool = False


@dataclass(frozen=True)
class Stages:
    """source: functions NAME_0 .. NAME_k; kept: how many V each but the last hands on.

    NAME_i(const V* x, const V* kept_0, .. const V* kept_(i-1), V* out): x are the inputs of that
    stage, one after the other; out is what is kept, and the function's outputs at the last.
    """

    source: str
    kept: tuple[int, ...]


def source_file(package: str, name: str) -> str:
    """The text of a C file that is installed with a package."""
    return files(package).joinpath(name).read_text(encoding="utf-8")


def in_stages(
    function: ca.Function, name: str, stages: Sequence[int], how: str = "INLINE"
) -> Stages:
    """The C of an SX function whose i-th input is known from stage stages[i] (0, 1, ..) on.

    how: INLINE or ALONE, as lanes.c defines them: copied to where it is called, or called.
    Raises NotImplementedError for an operation that has no C here.
    """
    values, outputs = _values(function, stages)
    last = max(stages)
    for value in values:
        for need in value.needs:
            values[need].kept |= 0 <= values[need].stage < value.stage
    for k in outputs:
        values[k].kept |= 0 <= values[k].stage < last
    slots: list[dict[int, int]] = []
    for stage in range(last):
        kept = [k for k, value in enumerate(values) if value.stage == stage and value.kept]
        slots.append({k: slot for slot, k in enumerate(kept)})
    lines = []
    for stage in range(last + 1):
        earlier = "".join(f", const V* restrict kept_{s}" for s in range(stage))
        lines.append(f"{how} void {name}_{stage}(const V* restrict x{earlier}, V* restrict out) {{")
        lines += [f"  (void)kept_{s};" for s in range(stage)]

        def named(k: int, stage: int = stage) -> str:
            s = values[k].stage
            if s < 0:
                return values[k].text
            return f"a{k}" if s == stage else f"kept_{s}[{slots[s][k]}]"

        for k, value in enumerate(values):
            if value.stage == stage:
                lines.append(f"  const V a{k} = {value.text.format(*map(named, value.needs))};")
        if stage == last:
            lines += [f"  out[{i}] = {named(k)};" for i, k in enumerate(outputs)]
        else:
            lines += [f"  out[{slot}] = a{k};" for k, slot in slots[stage].items()]
        lines.append("}")
    return Stages("\n".join(lines) + "\n", tuple(map(len, slots)))


def _values(function: ca.Function, stages: Sequence[int]) -> tuple[list[_Value], list[int]]:
    """Every value of the function, assigned once, and which of them are its outputs."""
    first_in: dict[int, int] = {}
    sizes = [0] * (max(stages) + 1)
    for i, stage in enumerate(stages):
        first_in[i] = sizes[stage]
        sizes[stage] += function.nnz_in(i)
    first_out = [0, *accumulate(function.nnz_out(i) for i in range(function.n_out()))]
    outputs = [-1] * first_out[-1]
    # CasADi reuses its registers: which value is in each of them now.
    register: dict[int, int] = {}
    inverse: dict[int, int] = {}
    values: list[_Value] = []
    for k in range(function.n_instructions()):
        code = function.instruction_id(k)
        out, args = function.instruction_output(k), function.instruction_input(k)
        if code == ca.OP_OUTPUT:
            outputs[first_out[out[0]] + out[1]] = register[args[0]]
            continue
        if code == ca.OP_INPUT:
            value = _Value(f"x[{first_in[args[0]] + args[1]}]", (), stages[args[0]])
        elif code == ca.OP_CONST:
            value = _Value(f"all({function.instruction_constant(k)!r})", (), -1)
        elif code in _BINARY or code in _UNARY:
            needs = tuple(register[a] for a in args[: 2 if code in _BINARY else 1])
            if code == ca.OP_DIV:
                # Many values are divided by the same one: inverted once, then multiplied by.
                divisor = needs[1]
                if divisor not in inverse:
                    inverse[divisor] = len(values)
                    stage = max(0, values[divisor].stage)
                    values.append(_Value("1.0 / {}", (divisor,), stage))
                needs = (needs[0], inverse[divisor])
            text = (_BINARY.get(code) or _UNARY[code])[1]
            value = _Value(text, needs, max(0, *(values[need].stage for need in needs)))
        else:
            raise NotImplementedError(f"operation {code} of {function.name()} has no C here")
        register[out[0]] = len(values)
        values.append(value)
    return values, outputs


_READ, _CONSTANT, _WRITE = object(), object(), object()

ArrayFunction = Callable[..., list[NDArray[np.float64]]]


def over_arrays(function: ca.Function) -> ArrayFunction:
    """An SX function as a function of arrays: one argument per scalar entry of its inputs.

    It takes `function.nnz_in()` arrays that broadcast and returns one array per nonzero of the
    outputs. Raises NotImplementedError for an operation that has no array form here.
    """
    starts = np.cumsum([0, *(function.nnz_in(i) for i in range(function.n_in()))])
    ends = np.cumsum([0, *(function.nnz_out(i) for i in range(function.n_out()))])
    steps: list[tuple[Any, int, Any, int | None]] = []
    for k in range(function.n_instructions()):
        code = function.instruction_id(k)
        out, args = function.instruction_output(k), function.instruction_input(k)
        if code == ca.OP_INPUT:
            steps.append((_READ, out[0], int(starts[args[0]] + args[1]), None))
        elif code == ca.OP_CONST:
            steps.append((_CONSTANT, out[0], np.float64(function.instruction_constant(k)), None))
        elif code == ca.OP_OUTPUT:
            steps.append((_WRITE, int(ends[out[0]] + out[1]), args[0], None))
        elif code in _BINARY:
            steps.append((_BINARY[code][0], out[0], args[0], args[1]))
        elif code in _UNARY:
            steps.append((_UNARY[code][0], out[0], args[0], None))
        else:
            raise NotImplementedError(f"operation {code} of {function.name()} has no array form")

    # CasADi reuses a register as soon as its value is not needed any more, so that few arrays are
    # alive at a time and they stay in the processor's cache.
    def evaluate(*arguments: ArrayLike) -> list[NDArray[np.float64]]:
        register: list = [None] * function.sz_w()
        results: list = [np.float64(0.0)] * int(ends[-1])
        for apply, where, one, two in steps:
            if two is not None:
                register[where] = apply(register[one], register[two])
            elif apply is _READ:
                register[where] = arguments[one]
            elif apply is _CONSTANT:
                register[where] = one
            elif apply is _WRITE:
                results[where] = register[one]
            else:
                register[where] = apply(register[one])
        return results

    return evaluate
