"""How a reader says that a file cannot be used."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

from rr_opt.files.issue import InvalidFileError, Issue

_MOST = 20
"""A file that is wrong in every row is told from its first ones."""


def refuse(file: str, message: str, line: int | None = None) -> NoReturn:
    """Raise InvalidFileError with one message about a file."""
    raise InvalidFileError([Issue("error", "", message, line, file)])


def refuse_all(file: str, found: Sequence[tuple[int, str]]) -> NoReturn:
    """Raise InvalidFileError with a line and a message for each mistake, the first of many."""
    issues = [Issue("error", "", message, line, file) for line, message in found[:_MOST]]
    if len(found) > _MOST:
        more = f"There are {len(found) - _MOST} more mistakes of this kind. Correct the first ones."
        issues.append(Issue("error", "", more, None, file))
    raise InvalidFileError(issues)
