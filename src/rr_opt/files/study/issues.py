"""What is wrong with the cases of a study, told once each, and where the study file says it."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

from rr_opt.files.document import Document
from rr_opt.files.document import Path as Keys
from rr_opt.files.issue import Issue, shown
from rr_opt.files.study.axes import Axis
from rr_opt.files.study.line import Line

_NUMBERS = re.compile(r"[-+]?[0-9][0-9.e+-]*|'[^']*'")


class CaseIssues:
    """Gathers the issues of case after case.

    An issue that a varied value is the reason of stands at that value in the study file and says
    which case has it first; one of the problem itself, which every case has, stands where it is.
    """

    def __init__(self, document: Document, axes: Sequence[Axis]):
        self._document, self._axes = document, axes
        self._lines = [line for axis in axes for line in axis.lines]
        self._cases = 0
        self._seen: dict[Issue, tuple[tuple[int, ...], int]] = {}

    def add(self, steps: tuple[int, ...], issues: Sequence[Issue]) -> None:
        """Note the issues of the case at these steps of the axes."""
        self._cases += 1
        for issue in dict.fromkeys(issues):
            first, count = self._seen.get(issue, (steps, 0))
            self._seen[issue] = first, count + 1

    def issues(self) -> list[Issue]:
        """All of them, those of one place together."""
        told: list[Issue] = []
        warned: set[tuple[Keys, str]] = set()
        for issue, (steps, count) in self._seen.items():
            line = self._reason(issue)
            if line is None and count == self._cases:
                told.append(issue)
                continue
            place: Keys = line.place if line else ()
            # A warning about one value says what it would say about the next.
            alike = place, _NUMBERS.sub("", issue.message)
            if issue.level == "warning" and alike in warned:
                continue
            warned.add(alike)
            where = f"{issue.path}: " if issue.path else ""
            message = f"{where}{issue.message}{self._cases_text(steps, count)}"
            told.append(self._document.issue(issue.level, place, message))
        return told

    def _cases_text(self, steps: tuple[int, ...], count: int) -> str:
        if count == self._cases:
            return ""
        case = ", ".join(self._value(one, steps) for one in self._lines)
        more = f", and {count - 1} more" if count > 1 else ""
        return f" (In the case {case}{more}.)"

    def _reason(self, issue: Issue) -> Line | None:
        """The varied key that an issue is about, if it is about one."""
        for line in self._lines:
            name = line.key.name
            # A robot's own file has its keys without `robot.`, a study those of its problem with
            # `problem.` before them.
            for varied in (name, name.removeprefix("robot."), f"problem.{name}"):
                if issue.path == varied or issue.path.startswith((f"{varied}.", f"{varied}[")):
                    return line
        return None

    def _value(self, line: Line, steps: tuple[int, ...]) -> str:
        for axis, step in zip(self._axes, steps, strict=True):
            if line in axis.lines:
                value = line.values[step]
                finite = isinstance(value, float) and math.isfinite(value)
                text = f"{value:.6g}" if finite else shown(value)
                return f"{line.key.name} = {text}"
        return line.key.name
