"""Input files of every kind: all mistakes in one at once, and the JSON Schema of its keys."""

from contextlib import suppress
from pathlib import Path
from typing import Any

from rr_opt.files.fields import schema_of
from rr_opt.files.issue import InvalidFileError, Issue
from rr_opt.files.problem_file import ProblemModel, kind_of, problem_from, problem_sources
from rr_opt.files.robot_file import RobotModel, robot_from, singular_posture
from rr_opt.files.source import experiment_path, problem_path, read_document
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import unknown_word
from rr_opt.outcome import InputError


def lint_file(path: str | Path) -> list[Issue]:
    """All issues of a robot, problem, study or experiment file, and of the files that it names.

    A folder stands for its problem.yaml, or else its experiment.yaml, whose recordings are not
    read. The keys of a file determine its kind, and only the reader of that kind is imported.
    Nothing is raised: a file that cannot be read is an issue too.
    """
    try:
        file = _file_of(Path(path))
        document = read_document(file)
        kind = kind_of(document)
        if kind == "robot":
            return _robot_issues(document)
        if kind == "study":
            from rr_opt.files.route_file import is_of_routes, routes_from
            from rr_opt.files.study_file import study_from

            of_routes = is_of_routes(document)
            return (routes_from if of_routes else study_from)(document, Path(path))[1]
        if kind == "route":
            from rr_opt.files.route_file import route_from

            return route_from(document, file)[1]
        if kind == "experiment":
            from rr_opt.files.experiment_file import plan_from

            return plan_from(document, file)[1]
        return problem_from(problem_sources(file))[1]
    except InvalidFileError as error:
        return list(error.issues)


def experiment_file(path: str | Path) -> Path | None:
    """The experiment file that a path stands for; None for anything else."""
    try:
        file = _file_of(Path(path))
        return file if kind_of(read_document(file)) == "experiment" else None
    except InvalidFileError:
        return None


def _file_of(path: Path) -> Path:
    """The file that a folder stands for; any other path as it is."""
    problem, experiment = problem_path(path), experiment_path(path)
    with suppress(OSError, ValueError):
        if not problem.exists() and experiment.exists():
            return experiment
    return problem


def _robot_issues(document: FileData) -> list[Issue]:
    """The issues of a robot on its own, without a problem to keep it from singular postures."""
    robot, issues = robot_from(document)
    notice = singular_posture(robot) if robot else None
    if notice:
        issues.append(document.warning(("servo", "angle_limit"), notice))
    return issues


def schema(kind: str) -> dict[str, Any]:
    """The JSON Schema (2020-12) of a kind of file: robot, problem, study, experiment or route.

    Editors use it to complete and check files. Every field carries a description with its unit; the
    SI unit alone is under `x-unit`. Raises InputError for any other kind.
    """
    from rr_opt.files.experiment_model import ExperimentModel
    from rr_opt.files.route_file import RouteModel
    from rr_opt.files.study_axes import StudyModel

    models = {
        "robot": RobotModel,
        "problem": ProblemModel,
        "study": StudyModel,
        "experiment": ExperimentModel,
        "route": RouteModel,
    }
    if kind not in models:
        raise InputError(unknown_word(kind, list(models), "kind of file"))
    return schema_of(models[kind], kind)
