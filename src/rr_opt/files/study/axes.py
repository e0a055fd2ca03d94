"""What a study varies, as axes: each a row of values, which are combined with every other's."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rr_opt.files.document import Document, Path
from rr_opt.files.issue import Issue, shown
from rr_opt.files.study.conflicts import refuse_repeats
from rr_opt.files.study.line import Line, line_at
from rr_opt.files.study.model import MOST_CASES
from rr_opt.files.study.units import Key
from rr_opt.outcome import InputError


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


def axes_of(document: Document) -> tuple[list[Axis], list[Issue]]:
    """The axes of a study file that can be used, and what is wrong with the others."""
    issues: list[Issue] = []

    def note(place: Path, message: str) -> None:
        issues.append(document.issue("error", place, message))

    seen: dict[Path, tuple[Key, object]] = {}
    axes: list[Axis] = []
    groups = _groups(document, note)
    for place, group in groups:
        lines = [line_at(document, (*place, key), seen, issues) for key in group]
        good = [line for line in lines if line is not None]
        lengths = {line.key.name: len(line.values) for line in good}
        if len(set(lengths.values())) > 1:
            told = ", ".join(f"{count} of `{name}`" for name, count in lengths.items())
            note(place, f"Read {told}. Expected as many of each, to take them in step.")
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
    document: Document, note: Callable[[Path, str], None]
) -> list[tuple[Path, dict[str, Any]]]:
    """The keys of each axis or axes, and where they stand."""
    groups: list[tuple[Path, dict[str, Any]]] = []
    if isinstance(varied := document.data.get("vary"), dict):
        groups += [(("vary",), {key: values}) for key, values in varied.items()]
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
