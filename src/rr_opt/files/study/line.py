"""The values of one key that a study varies: a list, or a range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rr_opt.files.document import Document, Path
from rr_opt.files.issue import Issue, shown
from rr_opt.files.model_issues import validate
from rr_opt.files.study.conflicts import refuse_conflict
from rr_opt.files.study.model import RangeModel
from rr_opt.files.study.ranges import doubt_about_units, range_values
from rr_opt.files.study.units import Key, key_of
from rr_opt.files.units import to_si
from rr_opt.outcome import InputError


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


def line_at(
    document: Document,
    place: Path,
    seen: dict[Path, tuple[Key, object]],
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
        return Line(key, tuple(data), _numbers(data, key), place)
    except InputError as error:
        issues.append(document.issue("error", place, str(error)))
        return None


def _ranged(
    document: Document, place: Path, key: Key, data: dict[str, Any], issues: list[Issue]
) -> Line | None:
    """The line of a range; None where a key of the range is wrong. Raises InputError as ranges."""
    inner = Document(document.file, data, document.lines, place)
    model, found = validate(RangeModel, inner)
    if model is None:
        for issue in found:
            at = (*place, issue.path.rsplit(".", 1)[-1])
            issues.append(document.issue("error", at, issue.message))
        return None
    numbers = range_values(model, key)
    doubt = doubt_about_units(model, key)
    if doubt:
        issues.append(document.issue("warning", place, doubt))
    return Line(key, numbers, numbers, place)


def _numbers(values: list[Any], key: Key) -> tuple[float, ...] | None:
    """The values in SI, if they are numbers. What is wrong with one is told by its case."""
    if key.unit is None:
        return None
    try:
        return tuple(to_si(value, key.unit) for value in values)
    except InputError:
        return None
