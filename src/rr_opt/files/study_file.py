"""From a study file to its cases, each a problem checked like any other."""

import copy
import itertools
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.files.fields import validate
from rr_opt.files.issue import InvalidFileError, Issue, has_errors, required
from rr_opt.files.problem_file import Sources, base_sources, problem_from, read_as, with_robot
from rr_opt.files.route_file import is_of_routes
from rr_opt.files.source import fingerprint
from rr_opt.files.study_axes import Axis, Line, StudyModel, axes_of
from rr_opt.files.yaml_text import FileData, KeyPath, path_text
from rr_opt.messages import shown
from rr_opt.model.problem import Problem
from rr_opt.outcome import InputError

Setting = tuple[KeyPath, Any]
"""The place of a value in the problem, and the value as in a file."""


def with_values(
    base: Sources, settings: Sequence[Setting], file: Path
) -> tuple[Sources, list[Issue]]:
    """The problem with values set in it, and an issue for each that has no place in it.

    Robots are named relative to `file`.
    """
    problem, robot = base.problem, base.robot
    problem = replace(problem, data=copy.deepcopy(problem.data))
    paths, issues = base.paths, base.issues
    misplaced: list[Issue] = []
    # A named robot is set first: other settings may change it.
    for keys, value in sorted(settings, key=lambda setting: len(setting[0])):
        if keys == ("robot",):
            changed = replace(problem, data={**problem.data, "robot": value})
            sources = with_robot(changed, file)
            problem, robot, issues = changed, sources.robot, sources.issues
            paths = (*paths, *sources.paths)
            continue
        target, below = problem, keys
        if keys[0] == "robot":
            if robot is None:
                continue
            target = robot = replace(robot, data=copy.deepcopy(robot.data))
            below = keys[1:]
        try:
            _set(target.data, below, value)
        except InputError as error:
            misplaced.append(Issue("error", path_text(keys), str(error)))
    return Sources(paths, problem, robot, issues), misplaced


def _set(data: Any, keys: KeyPath, value: Any) -> None:
    """Set a value in nested data, creating missing sections. Raises InputError without a place."""
    for depth, key in enumerate(keys, 1):
        if not _holds(data, key):
            held = f"a list of {len(data)}" if isinstance(data, list) else shown(data)
            number = "an entry of that number"
            wanted = number if isinstance(key, int) else "keys with values under it"
            raise InputError(
                f"The problem has {held} at `{path_text(keys[: depth - 1])}`. Expected {wanted}, "
                f"to set `{path_text(keys[:depth])}`. Write it in the problem first."
            )
        if depth == len(keys):
            data[key] = value
        elif isinstance(data, dict):
            data.setdefault(key, {} if isinstance(keys[depth], str) else [])
        data = data[key]


def _holds(data: Any, key: str | int) -> bool:
    """Whether a value may be set there: under any key of a section, at an index that a list has."""
    if isinstance(data, dict):
        return isinstance(key, str)
    return isinstance(data, list) and key in range(len(data))


_NUMBERS = re.compile(r"[-+]?[0-9][0-9.e+-]*|'[^']*'")


def _issues_of_cases(
    document: FileData,
    axes: Sequence[Axis],
    found: Mapping[Issue, Sequence[tuple[int, ...]]],
    count: int,
) -> Iterator[Issue]:
    """The issues of `count` cases, given with the steps of the axes that have them.

    An issue caused by a varied value is reported at that value in the study file, with the first
    case that has it; one of the problem itself, common to all cases, is reported in its own place.
    """
    warned: set[tuple[KeyPath, str]] = set()
    for issue, cases in found.items():
        line = next((line for axis in axes for line in axis.lines if _is_about(issue, line)), None)
        if line is None and len(cases) == count:
            yield issue
            continue
        place: KeyPath = line.place if line else ()
        # A warning about one value would be repeated for the next.
        alike = place, _NUMBERS.sub("", issue.message)
        if issue.level == "warning" and alike in warned:
            continue
        warned.add(alike)
        where = f"{issue.path}: " if issue.path else ""
        which = _cases_text(axes, cases) if len(cases) < count else ""
        yield document.issue(issue.level, place, f"{where}{issue.message}{which}")


def _is_about(issue: Issue, line: Line) -> bool:
    # Keys lack the prefix `robot.` in a robot's own file, and have the prefix `problem.` in a
    # study.
    name = line.key.name
    return any(
        issue.path == varied or issue.path.startswith((f"{varied}.", f"{varied}["))
        for varied in (name, name.removeprefix("robot."), f"problem.{name}")
    )


def _cases_text(axes: Sequence[Axis], cases: Sequence[tuple[int, ...]]) -> str:
    values = []
    for axis, step in zip(axes, cases[0], strict=True):
        for line in axis.lines:
            value = line.values[step]
            finite = isinstance(value, float) and math.isfinite(value)
            values.append(f"{line.key.name} = {f'{value:.6g}' if finite else shown(value)}")
    more = f", and {len(cases) - 1} more" if len(cases) > 1 else ""
    return f" (In the case {', '.join(values)}{more}.)"


@dataclass(frozen=True)
class Study:
    """A study as given: the product of its axes, one case per combination, the last axis fastest.

    problems  one per case
    sha256    over the study file and every file that it names, in hex
    """

    name: str
    axes: tuple[Axis, ...]
    problems: tuple[Problem, ...] = field(repr=False)
    sha256: str

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of steps of each axis."""
        return tuple(len(axis) for axis in self.axes)

    def steps(self, case: int) -> tuple[int, ...]:
        """The step of each axis in a case."""
        return tuple(map(int, np.unravel_index(case, self.shape)))

    def inputs(self, case: int) -> dict[str, Any]:
        """The varied keys of a case: numbers in SI, anything else as written."""
        return {
            line.key.name: line.given(step)
            for axis, step in zip(self.axes, self.steps(case), strict=True)
            for line in axis.lines
        }


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
        # Mistakes in the problem itself are reported together with those in the varied values.
        return None, list(dict.fromkeys([*issues, *problem_from(base)[1]]))
    problems: list[Problem] = []
    paths = [file, *base.paths]
    found_in: dict[Issue, list[tuple[int, ...]]] = {}
    for steps in itertools.product(*(range(len(axis)) for axis in axes)):
        settings = [
            (line.key.path, line.values[step])
            for axis, step in zip(axes, steps, strict=True)
            for line in axis.lines
        ]
        sources, misplaced = with_values(base, settings, file)
        paths += [path for path in sources.paths if path not in paths]
        problem, of_case = problem_from(sources)
        for issue in dict.fromkeys([*misplaced, *of_case]):
            found_in.setdefault(issue, []).append(steps)
        if problem is not None:
            problems.append(problem)
    issues += _issues_of_cases(document, axes, found_in, math.prod(map(len, axes)))
    if has_errors(issues):
        return None, issues
    return Study(file.stem, tuple(axes), tuple(problems), fingerprint(paths)), issues
