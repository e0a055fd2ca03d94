"""What a study varies: keys of a problem, in axes whose values are combined as a product."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, JsonValue, SkipValidation, WithJsonSchema, create_model

from rr_opt.files.fields import FileModel, schema_of, validate
from rr_opt.files.issue import Issue
from rr_opt.files.problem_file import ProblemModel
from rr_opt.files.yaml_text import FileData, KeyPath, path_text
from rr_opt.messages import shown, unknown_word
from rr_opt.outcome import InputError
from rr_opt.units import to_si, unit_written

MOST_CASES = 100_000


def _number(description: str, **default: Any) -> Any:
    """A field read later, when the unit of its key is known."""
    kinds: list[JsonValue] = [{"type": "number"}, {"type": "string"}]
    return Field(description=description, json_schema_extra={"anyOf": kinds}, **default)


# `from` cannot be a name in a class body.
RangeModel: Any = create_model(
    "RangeModel",
    __base__=FileModel,
    __doc__="Values from one to another, both included. Give count or step, not both.",
    **{
        "from": (Any, _number("The first value, with its unit if it has one.")),
        "to": (Any, _number("The last value.")),
        "count": (
            Annotated[int, Field(ge=2, le=MOST_CASES)],
            Field(default=None, description="How many values."),
        ),
        "step": (Any, _number("From one value to the next.", default=None)),
        "spacing": (
            Literal["linear", "log"],
            Field(default="linear", description="log: each value is the last times a factor."),
        ),
    },
)


_VALUES: JsonValue = {
    "type": "array",
    "minItems": 1,
    "description": "The values, one after another.",
}
_ONE: JsonValue = {"anyOf": [_VALUES, RangeModel.model_json_schema()]}
Varied = Annotated[
    dict[str, Any], SkipValidation, WithJsonSchema({"type": "object", "additionalProperties": _ONE})
]


class StudyModel(FileModel):
    """A problem solved again and again with other values of some of its keys.

    A key is named by its path in the problem file, `limits.rate` or `robot.platform2.I`, an entry
    of a list by its index, `robot.physics[0].force1` or `gait.period[1]`.
    """

    problem: Annotated[str | ProblemModel | None, SkipValidation] = Field(
        default=None,
        description="A problem file, relative to this file, or the problem itself. "
        "Without it: the paper's prototype.",
    )
    vary: Varied = Field(
        default_factory=dict,
        description="Keys of the problem, each with a list or a range of values. "
        "Every combination is a case.",
    )
    together: list[Varied] = Field(
        default_factory=list,
        description="Groups of keys with equally many values each, which are varied in step.",
    )
    routes: list[str] | None = Field(
        default=None,
        min_length=1,
        description="Instead of all others: route files, relative to this file, each a case.",
    )


_STEP = re.compile(r"(?:^|\.)([A-Za-z_][A-Za-z0-9_-]*)|\[([0-9]{1,3})\]")


@dataclass(frozen=True)
class ProblemKey:
    """A key of a problem file.

    unit   SI unit of a quantity, "" of a plain number, None of anything else
    """

    name: str
    path: KeyPath
    unit: str | None


def key_of(name: str) -> ProblemKey:
    """The key of this name. Raises InputError if no problem file has such a key."""
    path = _split(name)
    nodes = _unfolded([problem_schema()])
    unit = None
    for depth, part in enumerate(path):
        keys = [node.get("properties", {}) for node in nodes]
        if isinstance(part, int):
            below = [node["items"] for node in nodes if "items" in node]
        else:
            below = [key[part] for key in keys if part in key]
        if not below:
            raise InputError(_unknown(path[:depth], part, [one for key in keys for one in key]))
        nodes = _unfolded(below)
        # An end of a pair has the unit of the pair.
        units = [node["x-unit"] for node in nodes if "x-unit" in node]
        unit = units[0] if units else unit if isinstance(part, int) else None
    return ProblemKey(name, path, "" if unit == "dimensionless" else unit)


@lru_cache
def problem_schema() -> dict[str, Any]:
    """The JSON Schema of problem files, read once."""
    return schema_of(ProblemModel, "problem")


def _split(name: str) -> KeyPath:
    path: list[str | int] = []
    place = 0
    while place < len(name):
        step = _STEP.match(name, place)
        if step is None:
            break
        path.append(step[1] if step[1] else int(step[2]))
        place = step.end()
    if place < len(name) or not path:
        raise InputError(
            f"Read the key {name!r}. Expected the path of a key in a problem file. "
            "Write for example `limits.rate` or `robot.physics[0].force1`."
        )
    return tuple(path)


def _unfolded(nodes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Nodes of the schema, with references resolved and every alternative beside them."""
    seen: list[dict[str, Any]] = []
    todo = list(nodes)
    while todo:
        node = todo.pop()
        if "$ref" in node:
            todo.append(problem_schema()["$defs"][node["$ref"].removeprefix("#/$defs/")])
        todo += [*node.get("anyOf", []), *node.get("oneOf", [])]
        seen.append(node)
    return seen


def _unknown(before: KeyPath, part: str | int, known: list[str]) -> str:
    place = f"`{path_text(before)}`" if before else "a problem"
    if isinstance(part, int):
        return f"Read the index [{part}]. Expected a key: {place} is not a list. Delete the index."
    if not known:
        return f"Read `{part}` below {place}. Expected nothing: it has no keys. Delete `.{part}`."
    return unknown_word(part, list(dict.fromkeys(known)), f"key below {place},")


def refuse_conflict(
    key: ProblemKey, values: object, seen: Mapping[KeyPath, tuple[ProblemKey, object]]
) -> None:
    """Raise InputError if an earlier key is the same as this one, contains it, or is part of it.

    seen: each earlier key and its values, by its path. Robots that are named by their files may be
    varied together with keys within a robot.
    """
    for path, (other, others) in seen.items():
        if path == key.path:
            raise InputError(
                f"Read `{key.name}` twice. Expected a key to be varied once. Keep one of them."
            )
        short = min(len(path), len(key.path))
        if path[:short] != key.path[:short]:
            continue
        outer, inner, written = (other, key, others) if len(path) == short else (key, other, values)
        if outer.path == ("robot",) and _names(written):
            continue
        raise InputError(
            f"Read `{outer.name}` and `{inner.name}`, which is a part of it. Expected one of them "
            f"to be varied. Delete `{inner.name}` and write its values into those of "
            f"`{outer.name}`, or vary only parts."
        )


def _names(values: object) -> bool:
    return isinstance(values, list) and all(isinstance(value, str) for value in values)


_ROUNDING = 1e-9


def range_values(given: Any, key: ProblemKey) -> tuple[float, ...]:
    """The values of a RangeModel in SI, both ends included. Raises InputError if it has none."""
    first, last = getattr(given, "from"), given.to
    if key.unit is None:
        raise InputError(
            f"Read a range. Expected a list: `{key.name}` is not a number. Write [one, another]."
        )
    low, high = (to_si(value, key.unit) for value in (first, last))
    if not (math.isfinite(low) and math.isfinite(high)) or low == high:
        raise InputError(
            f"Read a range from {low:.6g} to {high:.6g}. Expected two different finite numbers. "
            "Write a list to vary nothing."
        )
    if bool(given.count) == (given.step is not None):
        raise InputError(
            "Read a range with "
            + ("both count and step" if given.count else "neither count nor step")
            + ". Expected one of them. Write for example `{from: 1, to: 3, count: 5}`."
        )
    if given.spacing == "log":
        if not given.count or low <= 0 or high <= 0:
            raise InputError(
                "Read `spacing: log`. Expected it with a count, from and to above 0. "
                "Give a count, or delete it."
            )
        values = np.geomspace(low, high, given.count)
    elif given.count:
        values = np.linspace(low, high, given.count)
    else:
        step = to_si(given.step, key.unit)
        steps = (high - low) / step if step else math.inf
        if not 0 < steps < MOST_CASES:
            raise InputError(
                f"Read the step {shown(given.step)}. Expected one that leads from "
                f"{shown(first)} to {shown(last)} in less than {MOST_CASES} steps. "
                "Change its sign or its size."
            )
        values = low + step * np.arange(math.floor(steps * (1 + _ROUNDING)) + 1)
    return tuple(float(value) for value in values)


def doubt_about_units(given: Any, key: ProblemKey) -> str | None:
    """A warning on a range that mixes a number without a unit and one with a unit.

    Zero is the same in every unit.
    """
    written = {"from": getattr(given, "from"), "to": given.to, "step": given.step}
    bare = [
        name
        for name, value in written.items()
        if value is not None and not _unit_of(value) and to_si(value, key.unit or "") != 0
    ]
    if not bare or not any(map(_unit_of, written.values())):
        return None
    values = " and ".join(f"`{name}: {shown(written[name])}`" for name in bare)
    return (
        f"Read {values} without a unit beside a value that has one. Expected a unit with each: "
        f"what has none is in {key.unit}. Write the unit."
    )


def _unit_of(value: object) -> str:
    """The unit that a value is written with; empty if there is none."""
    return unit_written(value) if isinstance(value, str) else ""


@dataclass(frozen=True)
class Line:
    """The values of one key.

    values   as a problem file would hold them
    numbers  the same in SI; None if not all of them are numbers
    unit     in which they were given, if it is a single one; else the key's, SI
    place    their place in the study file
    """

    key: ProblemKey
    values: tuple[Any, ...]
    numbers: tuple[float, ...] | None
    unit: str
    place: KeyPath

    def given(self, step: int) -> Any:
        """The value of a step: in SI if it is a number, else as text."""
        if self.numbers is not None:
            return self.numbers[step]
        value = self.values[step]
        return value if isinstance(value, str) else shown(value)


def line_at(
    document: FileData,
    place: KeyPath,
    seen: dict[KeyPath, tuple[ProblemKey, object]],
    issues: list[Issue],
) -> Line | None:
    """The values of the key at a place; None, with issues added, if something is wrong.

    seen: each earlier key and its values as written, by its path; this one is added.
    """
    data: Any = document.data
    for part in place:
        data = data[part]
    try:
        key = key_of(str(place[-1]))
        refuse_conflict(key, data, seen)
        seen[key.path] = key, data
        if isinstance(data, dict):
            model, found = validate(RangeModel, replace(document, data=data, prefix=place))
            issues += found
            if model is None:
                return None
            numbers = range_values(model, key)
            if doubt := doubt_about_units(model, key):
                issues.append(document.warning(place, doubt))
            return Line(key, numbers, numbers, _unit([data["from"], data["to"]], key), place)
        if not isinstance(data, list) or not data:
            raise InputError(
                f"Read {shown(data)}. Expected a list of values, or a range. Write for example "
                "`[1, 2, 3]` or `{from: 1, to: 3, count: 3}`."
            )
        return Line(key, tuple(data), _numbers(data, key), _unit(data, key), place)
    except InputError as error:
        issues.append(document.error(place, str(error)))
        return None


def _unit(values: list[Any], key: ProblemKey) -> str:
    """The unit shared by all values except 0 and infinity; else the key's, SI."""
    units = {_unit_of(value) for value in values if value not in (0, math.inf)}
    unit = units.pop() if len(units) == 1 else ""
    return unit or key.unit or ""


def _numbers(values: list[Any], key: ProblemKey) -> tuple[float, ...] | None:
    """The values in SI, if they are numbers. Wrong values are reported by their cases."""
    if key.unit is None:
        return None
    try:
        return tuple(to_si(value, key.unit) for value in values)
    except InputError:
        return None


@dataclass(frozen=True)
class Axis:
    """Lines whose values are varied together."""

    lines: tuple[Line, ...]

    def __len__(self) -> int:
        return len(self.lines[0].values)

    @property
    def numbers(self) -> tuple[float, ...] | None:
        """The values of its steps, in SI of its first numeric key; None if there is none."""
        return next((line.numbers for line in self.lines if line.numbers is not None), None)

    def refuse_repeats(self) -> None:
        """Raise InputError if two steps are the same, but for rounding."""
        first: dict[str, int] = {}
        for number in range(len(self)):
            step = [(line.numbers or line.values)[number] for line in self.lines]
            same = first.setdefault("\n".join(map(_digits, step)), number)
            if same != number:
                values = ", ".join(shown(line.values[number]) for line in self.lines)
                raise InputError(
                    f"Read {values} as value {number + 1}, which is value {same + 1} again. "
                    "Expected each value once. Delete one of them."
                )


def _digits(value: Any) -> str:
    """A value as text, equal for numbers that differ by rounding."""
    return f"{value:.11e}" if isinstance(value, float) else repr(value)


def axes_of(document: FileData) -> tuple[list[Axis], list[Issue]]:
    """The usable axes of a study file, and the issues of the others."""
    issues: list[Issue] = []

    def note(place: KeyPath, message: str) -> None:
        issues.append(document.error(place, message))

    seen: dict[KeyPath, tuple[ProblemKey, object]] = {}
    axes: list[Axis] = []
    groups = _groups(document, note)
    for place, group in groups:
        lines = [line_at(document, (*place, key), seen, issues) for key in group]
        good = [line for line in lines if line is not None]
        lengths = {line.key.name: len(line.values) for line in good}
        if len(set(lengths.values())) > 1:
            counts = ", ".join(f"{count} of `{name}`" for name, count in lengths.items())
            note(place, f"Read {counts}. Expected equally many of each, to vary them in step.")
        elif good and len(good) == len(lines):
            axis = Axis(tuple(good))
            try:
                axis.refuse_repeats()
            except InputError as error:
                note(good[0].place if len(good) == 1 else place, str(error))
            axes.append(axis)
    count = math.prod(len(axis) for axis in axes)
    if not groups:
        note((), "Nothing is varied. Expected `vary` or `together`. Add for example `vary: "
             "{limits.rate: {from: 10 rpm, to: 60 rpm, count: 11}}`.")  # fmt: skip
    elif count > MOST_CASES:
        note((), f"Read {count} cases. Expected at most {MOST_CASES}. Vary fewer values.")
    return axes, issues


def _groups(
    document: FileData, note: Callable[[KeyPath, str], None]
) -> list[tuple[KeyPath, dict[str, Any]]]:
    """The keys of each axis or axes, and their places."""
    groups: list[tuple[KeyPath, dict[str, Any]]] = []
    varied = document.data.get("vary", {})
    if isinstance(varied, dict):
        groups += [(("vary",), {key: values}) for key, values in varied.items()]
    else:
        note(("vary",), f"Read {shown(varied)}. Expected keys, each with its values. Write for "
             "example `{limits.rate: {from: 10 rpm, to: 60 rpm, count: 11}}`.")  # fmt: skip
    if isinstance(together := document.data.get("together"), list):
        for number, group in enumerate(together):
            if isinstance(group, dict) and group:
                groups.append((("together", number), group))
                continue
            note(("together", number),
                 f"Read {shown(group)}. Expected keys, each with as many values. Delete it, or "
                 "write for example `{robot.platform1.m: [1, 2], robot.platform2.m: [1, 2]}`.",
            )  # fmt: skip
    return groups
