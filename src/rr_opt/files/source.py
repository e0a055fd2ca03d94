"""Where input files come from: the user's disk, or the package with its shipped problem."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from rr_opt.files.document import Document
from rr_opt.files.issue import InvalidFileError, Issue
from rr_opt.files.result_text import parse_result
from rr_opt.files.yaml_text import LARGEST, parse_yaml

SHIPPED = Path(str(files("rr_opt"))) / "data" / "prototype"
"""The folder with the paper's prototype: robot.yaml and problem.yaml."""


def read_document(path: Path) -> Document:
    """The data of a YAML file, or of a result. Raises InvalidFileError with all that is wrong."""
    content = read_content(path)
    return parse_result(content, str(path)) or parse_yaml(content, str(path))


def read_content(path: Path) -> bytes:
    """The bytes of a file, one more than `LARGEST` at most. Raises InvalidFileError."""
    try:
        with path.open("rb") as file:
            return file.read(LARGEST + 1)
    except FileNotFoundError:
        why = "There is no such file. Check its name and folder."
    except IsADirectoryError:
        why = "This is a folder. Expected a file."
    except (OSError, ValueError) as error:
        why = f"The file cannot be read: {getattr(error, 'strerror', None) or error}."
    raise InvalidFileError([Issue("error", "", why, None, str(path))])


def problem_path(path: Path) -> Path:
    """The problem file of a folder; any other path as it is."""
    try:
        return path / "problem.yaml" if path.is_dir() else path
    except OSError:
        return path
