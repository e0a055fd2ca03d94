"""What a study varies, as axes: each a row of values, which are combined with every other's."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_opt.files.document import Document, Path
from rr_opt.files.issue import Issue, shown
from rr_opt.files.model_issues import validate
from rr_opt.files.study.model import MOST_CASES, RangeModel
from rr_opt.files.study.units import Key, key_of
from rr_opt.files.units import to_si
from rr_opt.outcome import InputError

_ROUNDING = 1e-9


@dataclass(frozen=True)
class Line:
    """The values of one key.

    values   as a problem file would hold them
    numbers  the same in SI; None if not all of them are numbers
    place    where in the study file they stand
    """

    key: Key
    values: tuple[Any, ...]
    numbers: tuple[float, ...] | None
    place: Path


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


def axes_of(document: Document) -> tuple[list[Axis], list[Issue]]:
    """The axes of a study file that can be used, and what is wrong with the others."""
    issues: list[Issue] = []

    def note(place: Path, message: str) -> None:
        issues.append(document.issue("error", place, message))

    seen: dict[str, Path] = {}
    axes: list[Axis] = []
    groups: list[tuple[Path, dict[str, Any]]] = []
    if isinstance(varied := document.data.get("vary"), dict):
        groups += [(("vary",), {key: values}) for key, values in varied.items()]
    if isinstance(together := document.data.get("together"), list):
        groups += [(("together", i), g) for i, g in enumerate(together) if isinstance(g, dict)]
    for place, group in groups:
        lines = [_line(document, (*place, key), seen, note) for key in group]
        good = [line for line in lines if line is not None]
        lengths = {line.key.name: len(line.values) for line in good}
        if len(set(lengths.values())) > 1:
            told = ", ".join(f"{count} of `{name}`" for name, count in lengths.items())
            note(place, f"Read {told}. Expected as many of each, to take them in step.")
        elif good and len(good) == len(lines):
            axes.append(Axis(tuple(good)))
    count = math.prod(len(axis) for axis in axes)
    if not groups:
        note((), "Nothing is varied. Expected `vary` or `together`. Add for example `vary: "
             "{limits.rate: {from: 10 rpm, to: 60 rpm, count: 11}}`.")  # fmt: skip
    elif count > MOST_CASES:
        note((), f"Read {count} cases. Expected at most {MOST_CASES}. Vary fewer values.")
    return axes, issues


def _line(
    document: Document, place: Path, seen: dict[str, Path], note: Callable[[Path, str], None]
) -> Line | None:
    data: Any = document.data
    for part in place:
        data = data[part]
    try:
        key = key_of(str(place[-1]))
        if key.name in seen:
            raise InputError(f"`{key.name}` is varied twice. Keep one.")
        seen[key.name] = place
        if isinstance(data, dict):
            inner = Document(document.file, data, document.lines, place)
            model, found = validate(RangeModel, inner)
            if model is None:
                for issue in found:
                    note((*place, issue.path.rsplit(".", 1)[-1]), issue.message)
                return None
            numbers = tuple(_range(model, key))
            return Line(key, numbers, numbers, place)
        if not isinstance(data, list) or not data:
            raise InputError(
                f"Read {shown(data)}. Expected a list of values, or a range. Write for example "
                "`[1, 2, 3]` or `{from: 1, to: 3, count: 3}`."
            )
        return Line(key, tuple(data), _numbers(data, key), place)
    except InputError as error:
        note(place, str(error))
        return None


def _numbers(values: list[Any], key: Key) -> tuple[float, ...] | None:
    """The values in SI, if they are numbers. What is wrong with one is told by its case."""
    if key.unit is None:
        return None
    try:
        return tuple(to_si(value, key.unit) for value in values)
    except InputError:
        return None


def _range(given: Any, key: Key) -> list[float]:
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
    return [float(value) for value in values]
