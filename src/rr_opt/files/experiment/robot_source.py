"""The experiment file's `robot`: written there, or in a file that it names."""

from __future__ import annotations

from pathlib import Path

from rr_opt.files.document import Document
from rr_opt.files.issue import InvalidFileError, Issue, shown
from rr_opt.files.robot_file import robot_from
from rr_opt.files.source import read_document
from rr_opt.robot.parameters import Robot


def robot_of(document: Document, file: Path) -> tuple[Robot | None, list[Path], list[Issue]]:
    """The robot (None if it cannot be read), the files it is in beside this one, and all issues."""
    if "robot" not in document.data:
        return None, [], []  # told with the other keys that are missing
    given = document.data["robot"]
    if isinstance(given, dict):
        return _with_paths(robot_from(document.section("robot")), [])
    if not isinstance(given, str) or not given:
        message = f"Read {shown(given)}. Expected the name of a robot file, or the robot itself."
        return None, [], [document.issue("error", ("robot",), message)]
    named = file.parent / given
    try:
        return _with_paths(robot_from(read_document(named)), [named])
    except InvalidFileError as error:
        issues = [
            document.issue("error", ("robot",), f"Read {shown(given)}. {one.message}")
            if one.line is None
            else one
            for one in error.issues
        ]
        return None, [], issues


def _with_paths(
    read: tuple[Robot | None, list[Issue]], paths: list[Path]
) -> tuple[Robot | None, list[Path], list[Issue]]:
    robot, issues = read
    return robot, paths, issues
