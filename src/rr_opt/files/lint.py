"""Every problem of a file at once, before anything is computed from it."""

from __future__ import annotations

from pathlib import Path

from rr_opt.files.document import Document
from rr_opt.files.issue import InvalidFileError, Issue
from rr_opt.files.kind import kind_of
from rr_opt.files.problem_file import problem_from
from rr_opt.files.problem_sources import problem_sources
from rr_opt.files.robot_file import robot_from
from rr_opt.files.robot_sense import singular_posture
from rr_opt.files.source import problem_path, read_document
from rr_opt.files.study.file import study_from


def lint_file(path: str | Path) -> list[Issue]:
    """All issues of a robot, problem or study file, and of the files that it names.

    A folder stands for its problem.yaml. The kind of the file is told from its keys. Nothing
    is raised: a file that cannot be read is an issue too.
    """
    try:
        document = read_document(problem_path(Path(path)))
        kind = kind_of(document)
        if kind == "robot":
            return _robot_issues(document)
        if kind == "study":
            return study_from(document, Path(path))[1]
        return problem_from(problem_sources(path))[1]
    except InvalidFileError as error:
        return list(error.issues)


def _robot_issues(document: Document) -> list[Issue]:
    """Those of a robot that stands alone, without a problem to keep it from singular postures."""
    robot, issues = robot_from(document)
    notice = singular_posture(robot) if robot else None
    if notice:
        issues.append(document.issue("warning", ("servo", "angle_limit"), notice))
    return issues
