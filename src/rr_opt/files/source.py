"""Where input files come from: the user's disk, the package, or a result that rr-opt wrote."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path

from rr_opt.files.gate import LONG, read_content
from rr_opt.files.issue import InvalidFileError, Issue
from rr_opt.files.yaml_text import Document, parse_yaml
from rr_opt.messages import shown

_MARKS = ("status", "input_sha256")
"""Keys that every result has and no input."""


def parse_result(content: bytes, file: str) -> Document | None:
    """The data of a result; None if the content is anything else.

    A result may hold more numbers than an input file may, and no line of it is worth naming.
    """
    if not content.lstrip().startswith(b"{"):
        return None
    try:
        data = json.loads(content)
    except (ValueError, RecursionError):
        return None
    return Document(file, data, {}) if is_result(data) else None


def is_result(data: object) -> bool:
    """Whether a mapping is a result of rr-opt."""
    return isinstance(data, dict) and all(key in data for key in _MARKS)


SHIPPED = Path(str(files("rr_opt"))) / "data" / "prototype"
"""The folder with the paper's prototype: robot.yaml and problem.yaml."""


def read_document(path: Path) -> Document:
    """The data of a YAML file, or of a result. Raises InvalidFileError with all that is wrong."""
    content = read_content(path)
    return parse_result(content, str(path)) or parse_yaml(content, str(path))


def linked(
    document: Document, key: str, folder: Path, expected: str
) -> tuple[Document | None, tuple[Path, ...], list[Issue]]:
    """What stands under a key: a mapping, or the document in the file that it names.

    None where it cannot be read, with all issues; and the file that it is in, if it is another.
    expected: what the key should hold, for the message.
    """
    given = document.data[key]
    if isinstance(given, dict):
        return document.section(key), (), []
    if not isinstance(given, str) or not given:
        message = f"Read {shown(given)}. Expected {expected}."
        return None, (), [document.issue("error", (key,), message)]
    named = folder / given
    try:
        return read_document(named), (named,), []
    except InvalidFileError as error:
        # What is wrong with the name stands where it is written.
        message = f"Read {shown(given)}. {error.issues[0].message}"
        if error.issues[0].line is None:
            return None, (named,), [document.issue("error", (key,), message)]
        return None, (named,), list(error.issues)


def fingerprint(paths: Iterable[Path]) -> str:
    """SHA-256, in hex, over the bytes of files. Raises InvalidFileError if one is unreadable.

    Each is preceded by its length, so that none can pass for two.
    """
    digest = hashlib.sha256()
    for path in paths:
        content = read_content(path, LONG)
        digest.update(f"{len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def problem_path(path: Path) -> Path:
    """The problem file of a folder; any other path as it is."""
    try:
        return path / "problem.yaml" if path.is_dir() else path
    except OSError:
        return path
