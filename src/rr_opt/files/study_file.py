"""A study file to its cases, each a problem of its own that was checked like any other."""

import itertools
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.files.fields import validate
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, required
from rr_opt.files.problem_file import base_sources, problem_from, read_as
from rr_opt.files.problem_model import StudyModel
from rr_opt.files.route_study_file import is_of_routes
from rr_opt.files.source import fingerprint
from rr_opt.files.study_axes import Axis, Line, axes_of
from rr_opt.files.study_keys import with_values
from rr_opt.files.yaml_text import FileData, KeyPath
from rr_opt.messages import shown
from rr_opt.model.problem import Problem

_NUMBERS = re.compile(r"[-+]?[0-9][0-9.e+-]*|'[^']*'")


class CaseIssues:
    """Gathers the issues of case after case.

    An issue that a varied value is the reason of stands at that value in the study file and says
    which case has it first; one of the problem itself, which every case has, stands where it is.
    """

    def __init__(self, document: FileData, axes: Sequence[Axis]):
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
        new: list[Issue] = []
        warned: set[tuple[KeyPath, str]] = set()
        for issue, (steps, count) in self._seen.items():
            line = self._reason(issue)
            if line is None and count == self._cases:
                new.append(issue)
                continue
            place: KeyPath = line.place if line else ()
            # A warning about one value says what it would say about the next.
            alike = place, _NUMBERS.sub("", issue.message)
            if issue.level == "warning" and alike in warned:
                continue
            warned.add(alike)
            where = f"{issue.path}: " if issue.path else ""
            message = f"{where}{issue.message}{self._cases_text(steps, count)}"
            new.append(self._document.issue(issue.level, place, message))
        return new

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


@dataclass(frozen=True)
class Study:
    """A study as asked: the product of its axes, a case a combination, the last axis fastest.

    problems  one a case
    sha256    over the study file and every file that it names, in hex
    """

    name: str
    axes: tuple[Axis, ...]
    problems: tuple[Problem, ...] = field(repr=False)
    sha256: str

    @property
    def shape(self) -> tuple[int, ...]:
        """How many steps each axis has."""
        return tuple(len(axis) for axis in self.axes)

    def steps(self, case: int) -> tuple[int, ...]:
        """Which step of each axis a case is."""
        return tuple(map(int, np.unravel_index(case, self.shape)))

    def inputs(self, case: int) -> dict[str, Any]:
        """The varied keys of a case: SI where they are numbers, as written elsewhere."""
        found: dict[str, Any] = {}
        for axis, step in zip(self.axes, self.steps(case), strict=True):
            for line in axis.lines:
                value = line.values[step]
                found[line.key.name] = (
                    line.numbers[step]
                    if line.numbers is not None
                    else value
                    if isinstance(value, str)
                    else shown(value)
                )
        return found


def read_study(path: str | Path) -> tuple[Study, list[Issue]]:
    """The study of a file, and warnings. Raises InvalidFileError with all that is wrong."""
    file = Path(path)
    expected = (
        "Read a file that varies nothing. Expected a study, with `problem` and `vary`. "
        "A single problem is solved by `rr-opt maximize-speed`."
    )
    document = read_as("study", file, expected)
    if is_of_routes(document):
        message = "Read a study of routes. Expected one of a problem. `rr.routes` drives them."
        raise InvalidFileError([document.error(("routes",), message)])
    study, issues = study_from(document, file)
    return required(study, issues), issues


def study_from(document: FileData, file: Path) -> tuple[Study | None, list[Issue]]:
    """The study (None if an issue is an error), and all issues of it and of every case."""
    _, issues = validate(StudyModel, document)
    axes, found = axes_of(document)
    issues += found
    try:
        base = base_sources(document, file)
    except InvalidFileError as error:
        return None, [*issues, *error.issues]
    if has_errors(issues):
        # Mistakes in the problem itself are reported together with those in what is varied.
        return None, list(dict.fromkeys([*issues, *problem_from(base)[1]]))
    problems: list[Problem] = []
    paths = [file, *base.paths]
    found_in = CaseIssues(document, axes)
    for steps in itertools.product(*(range(len(axis)) for axis in axes)):
        settings = [
            (line.key.path, line.values[step])
            for axis, step in zip(axes, steps, strict=True)
            for line in axis.lines
        ]
        sources, misplaced = with_values(base, settings, file)
        paths += [path for path in sources.paths if path not in paths]
        problem, of_case = problem_from(sources)
        found_in.add(steps, [*misplaced, *of_case])
        if problem is not None:
            problems.append(problem)
    issues += found_in.issues()
    if has_errors(issues):
        return None, issues
    return Study(file.stem, tuple(axes), tuple(problems), fingerprint(paths)), issues
