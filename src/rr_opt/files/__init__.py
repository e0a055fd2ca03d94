"""Input files: YAML with units, checked whole before anything runs, to frozen data."""

from rr_opt.files.issue import InvalidFileError, Issue
from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import input_sha256, read_problem
from rr_opt.files.robot_file import read_robot, robot_from
from rr_opt.files.schemas import schema
from rr_opt.files.source import read_document
from rr_opt.files.units import to_si

__all__ = [
    "InvalidFileError",
    "Issue",
    "input_sha256",
    "lint_file",
    "read_document",
    "read_problem",
    "read_robot",
    "robot_from",
    "schema",
    "to_si",
]
