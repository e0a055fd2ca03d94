"""Which files make up a problem, and the mappings in them: the problem and its robot."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rr_opt.files.document import Document
from rr_opt.files.issue import InvalidFileError, Issue, shown
from rr_opt.files.kind import kind_of
from rr_opt.files.result_text import is_result
from rr_opt.files.source import SHIPPED, problem_path, read_document


@dataclass(frozen=True)
class Sources:
    """A problem as read, nothing of it checked but its YAML.

    paths   the files it is made of
    robot   None if it could not be read; `issues` say why
    """

    paths: tuple[Path, ...]
    problem: Document
    robot: Document | None
    issues: tuple[Issue, ...] = ()


def problem_sources(path: str | Path | None) -> Sources:
    """The parts of a problem: a problem file, its folder, a robot file, or None (as shipped).

    A robot file stands for the shipped problem with that robot and its servo's limits.
    Raises InvalidFileError if the file cannot be read, or is of another kind.
    """
    file = problem_path(SHIPPED if path is None else Path(path))
    document = read_document(file)
    kind = kind_of(document)
    if kind == "experiment":
        raise InvalidFileError([experiment_issue(document)])
    if kind == "result":
        raise InvalidFileError([result_issue(document)])
    if kind == "study":
        raise InvalidFileError([study_issue(document)])
    if kind == "robot":
        return _shipped_problem_with(document, file)
    if isinstance(document.data.get("robot"), dict):
        return Sources((file,), document, document.section("robot"))
    return _with_robot_file(document, file)


def experiment_issue(document: Document) -> Issue:
    """What to say to an experiment file where a robot or a problem is expected."""
    return document.issue(
        "error",
        (),
        "Read the keys of an experiment. Expected a problem or a robot. "
        "Experiments are read by `rr-opt diagnose`.",
    )


def study_issue(document: Document) -> Issue:
    """What to say to a study where a problem is expected."""
    return document.issue(
        "error",
        (),
        "Read the keys of a study. Expected a problem or a robot. "
        "Studies are solved by `rr-opt study`.",
    )


def result_issue(document: Document) -> Issue:
    """What to say to a result where an input file is expected."""
    return document.issue(
        "error",
        (),
        "Read a result, which rr-opt has written. Expected an input file: a problem or a robot. "
        "Results are read by `rr-opt simulate` and `rr-opt export`.",
    )


def _shipped_problem_with(robot: Document, file: Path) -> Sources:
    problem = read_document(SHIPPED / "problem.yaml")
    limits = problem.section("limits").without("angle", "rate", "torque").data
    data = {**problem.without("robot").data, "limits": limits}
    shipped = Document(f"the shipped problem, with {file}", data, problem.lines)
    return Sources((SHIPPED / "problem.yaml", file), shipped, robot)


def _with_robot_file(problem: Document, file: Path) -> Sources:
    entry = problem.data.get("robot")
    if "robot" not in problem.data:
        named = SHIPPED / "robot.yaml"
    elif isinstance(entry, str) and entry:
        named = file.parent / entry
    else:
        message = (
            f"Read {shown(entry)}. Expected the name of a robot file, or the robot itself. "
            "Without this key the robot is the paper's prototype."
        )
        return Sources((file,), problem, None, (problem.issue("error", ("robot",), message),))
    try:
        robot = read_document(named)
        if is_result(robot.data):
            message = (
                f"Read {shown(entry)}, a result. Expected a robot file. Write what the result "
                "holds under `robot` to a file, and name that."
            )
            return Sources(
                (file, named), problem, None, (problem.issue("error", ("robot",), message),)
            )
        return Sources((file, named), problem, robot)
    except InvalidFileError as error:
        issues = tuple(
            problem.issue("error", ("robot",), f"Read {shown(entry)}. {issue.message}")
            if issue.line is None
            else issue
            for issue in error.issues
        )
        return Sources((file, named), problem, None, issues)
