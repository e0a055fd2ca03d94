"""What a study varies, as axes: each a row of values, which are combined with every other's."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_opt.files.fields import validate
from rr_opt.files.issue import Issue
from rr_opt.files.problem_model import MOST_CASES, RangeModel
from rr_opt.files.study_keys import ProblemKey, key_of
from rr_opt.files.yaml_text import FileData, KeyPath
from rr_opt.messages import shown
from rr_opt.outcome import InputError
from rr_opt.units import to_si, unit_written


def refuse_conflict(
    key: ProblemKey, values: object, seen: Mapping[KeyPath, tuple[ProblemKey, object]]
) -> None:
    """Raise InputError if one of the keys before is this one, holds it, or is held by it.

    seen: each key before and its values, by its path. Robots that are named by their files may be
    varied together with what is within a robot.
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


def refuse_repeats(steps: Sequence[tuple[Any, ...]], written: Sequence[tuple[Any, ...]]) -> None:
    """Raise InputError if two steps of an axis are the same.

    A step has a value for each key of the axis: in SI if it is a number, and as written.
    """
    first: dict[str, int] = {}
    for number, step in enumerate(steps, 1):
        same = first.setdefault("\n".join(_digits(value) for value in step), number)
        if same != number:
            values = ", ".join(shown(value) for value in written[number - 1])
            raise InputError(
                f"Read {values} as value {number}, which is value {same} again. Expected each "
                "value once. Delete one of them."
            )


def _names(values: object) -> bool:
    return isinstance(values, list) and all(isinstance(value, str) for value in values)


def _digits(value: Any) -> str:
    """A value as text, the same for numbers that differ by rounding."""
    return f"{value:.11e}" if isinstance(value, float) else repr(value)


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
    """A sentence on a range in which a number without a unit stands beside one with a unit.

    Zero is the same in every unit.
    """
    written = {"from": getattr(given, "from"), "to": given.to, "step": given.step}
    bare = [
        name
        for name, value in written.items()
        if value is not None and not _has_unit(value) and to_si(value, key.unit or "") != 0
    ]
    if not bare or not any(_has_unit(value) for value in written.values()):
        return None
    values = " and ".join(f"`{name}: {shown(written[name])}`" for name in bare)
    return (
        f"Read {values} without a unit beside a value that has one. Expected a unit with each: "
        f"what has none is in {key.unit}. Write the unit."
    )


def _has_unit(value: object) -> bool:
    if not isinstance(value, str):
        return False
    try:
        float(value)
    except ValueError:
        return True
    return False


@dataclass(frozen=True)
class Line:
    """The values of one key.

    values   as a problem file would hold them
    numbers  the same in SI; None if not all of them are numbers
    unit     in which they were asked for, if in one; else the key's, SI
    place    where in the study file they stand
    """

    key: ProblemKey
    values: tuple[Any, ...]
    numbers: tuple[float, ...] | None
    unit: str
    place: KeyPath


def line_at(
    document: FileData,
    place: KeyPath,
    seen: dict[KeyPath, tuple[ProblemKey, object]],
    issues: list[Issue],
) -> Line | None:
    """The values of the key at a place; None, and issues added, where something is wrong.

    seen: each key before and its values as written, by its path; this one is added.
    """
    data: Any = document.data
    for part in place:
        data = data[part]
    try:
        key = key_of(str(place[-1]))
        refuse_conflict(key, data, seen)
        seen[key.path] = key, data
        if isinstance(data, dict):
            return _ranged(document, place, key, data, issues)
        if not isinstance(data, list) or not data:
            raise InputError(
                f"Read {shown(data)}. Expected a list of values, or a range. Write for example "
                "`[1, 2, 3]` or `{from: 1, to: 3, count: 3}`."
            )
        return Line(key, tuple(data), _numbers(data, key), _unit(data, key), place)
    except InputError as error:
        issues.append(document.error(place, str(error)))
        return None


def _ranged(
    document: FileData, place: KeyPath, key: ProblemKey, data: dict[str, Any], issues: list[Issue]
) -> Line | None:
    """The line of a range; None where a key of the range is wrong. Raises InputError as ranges."""
    inner = FileData(document.file, data, document.lines, place)
    model, found = validate(RangeModel, inner)
    if model is None:
        for issue in found:
            at = (*place, issue.path.rsplit(".", 1)[-1])
            issues.append(document.error(at, issue.message))
        return None
    numbers = range_values(model, key)
    doubt = doubt_about_units(model, key)
    if doubt:
        issues.append(document.warning(place, doubt))
    ends = [data["from"], data["to"]]
    return Line(key, numbers, numbers, _unit(ends, key), place)


def _unit(values: list[Any], key: ProblemKey) -> str:
    """The unit that all values but those that are 0 or infinite have; else the key's, SI."""
    units = {
        unit_written(value) if isinstance(value, str) else ""
        for value in values
        if value not in (0, math.inf)
    }
    unit = units.pop() if len(units) == 1 else ""
    return unit or key.unit or ""


def _numbers(values: list[Any], key: ProblemKey) -> tuple[float, ...] | None:
    """The values in SI, if they are numbers. A wrong value is reported by its case."""
    if key.unit is None:
        return None
    try:
        return tuple(to_si(value, key.unit) for value in values)
    except InputError:
        return None


@dataclass(frozen=True)
class Axis:
    """Lines whose values are taken in step."""

    lines: tuple[Line, ...]

    def __len__(self) -> int:
        return len(self.lines[0].values)

    @property
    def numbers(self) -> tuple[float, ...] | None:
        """Where its steps lie, in SI of its first key that is a number; None if none is."""
        return next((line.numbers for line in self.lines if line.numbers is not None), None)

    @property
    def steps(self) -> list[tuple[Any, ...]]:
        """The values of each step, those that are numbers in SI."""
        columns = [line.values if line.numbers is None else line.numbers for line in self.lines]
        return list(zip(*columns, strict=True))

    @property
    def written(self) -> list[tuple[Any, ...]]:
        """The values of each step, as a problem file would hold them."""
        return list(zip(*(line.values for line in self.lines), strict=True))


def axes_of(document: FileData) -> tuple[list[Axis], list[Issue]]:
    """The axes of a study file that can be used, and what is wrong with the others."""
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
            note(place, f"Read {counts}. Expected as many of each, to take them in step.")
        elif good and len(good) == len(lines):
            axis = Axis(tuple(good))
            try:
                refuse_repeats(axis.steps, axis.written)
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
    """The keys of each axis or axes, and where they stand."""
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
