"""Mistakes in a file, as data: one issue per problem, and the error that carries them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NoReturn, TypeVar

from rr_opt.outcome import InputError

Level = Literal["error", "warning"]
Read = TypeVar("Read")


@dataclass(frozen=True)
class Issue:
    """One problem of a file.

    path     key path, such as `platform1.m` or `physics[0].name`; empty for the whole file
    message  what was read, what was expected, what to do
    line     line of the key (the first is 1), None if it is unknown
    file     the file as the user named it
    """

    level: Level
    path: str
    message: str
    line: int | None = None
    file: str = ""

    def __str__(self) -> str:
        place = self.file if self.line is None else f"{self.file}:{self.line}"
        head = "" if self.level == "error" else "warning: "
        return ": ".join(part for part in (place, self.path, head + self.message) if part)


class InvalidFileError(InputError):
    """A file cannot be used; `issues` are all its problems, and str() lists them one a line."""

    def __init__(self, issues: Iterable[Issue]):
        self.issues = tuple(issues)
        super().__init__("\n".join(str(issue) for issue in self.issues))


def required(read: Read | None, issues: Iterable[Issue]) -> Read:
    """What was read. Raises InvalidFileError with all issues if it could not be."""
    if read is None:
        raise InvalidFileError(issues)
    return read


def has_errors(issues: Iterable[Issue]) -> bool:
    """True if one of the issues is an error and not only a warning."""
    return any(issue.level == "error" for issue in issues)


MOST_LISTED, MOST_COUNTED = 20, 10_000
"""Most mistakes listed, and counted, for a file that is wrong in every row."""


def refuse(file: str, message: str, line: int | None = None) -> NoReturn:
    """Raise InvalidFileError with one message about a file."""
    raise InvalidFileError([Issue("error", "", message, line, file)])


def refuse_all(file: str, found: Sequence[tuple[int, str]], count: int) -> NoReturn:
    """Raise InvalidFileError with line and message of each of the first of `count` mistakes."""
    issues = [Issue("error", "", message, line, file) for line, message in found]
    if count > MOST_LISTED:
        others = f"{count - MOST_LISTED} more" if count < MOST_COUNTED else "thousands of other"
        more = f"There are {others} mistakes of this kind. Correct the first ones."
        issues.append(Issue("error", "", more, None, file))
    raise InvalidFileError(issues)
