"""Where input files come from: the user's disk, the package, or a result of rr-opt.

Only regular files of bounded size are read: a pipe or a device may never end. Input may be a link;
output never replaces or follows one.
"""

import hashlib
import json
import os
import stat
from collections.abc import Iterable
from contextlib import suppress
from importlib.resources import files
from pathlib import Path

from rr_opt.files.issue import InvalidFileError, Issue, refuse
from rr_opt.files.yaml_text import FileData, parse_yaml
from rr_opt.messages import shown
from rr_opt.outcome import InputError

_MARKS = ("status", "input_sha256")
"""Keys that every result has and no input file has."""


def is_result(data: object) -> bool:
    """Whether a mapping is a result of rr-opt."""
    return isinstance(data, dict) and all(key in data for key in _MARKS)


SHIPPED = Path(str(files("rr_opt"))) / "data" / "prototype"
"""The folder with the paper's prototype: robot.yaml and problem.yaml."""


def read_document(path: Path) -> FileData:
    """The data of a YAML file, or of a result. Raises InvalidFileError with all that is wrong.

    A result may be larger than an input file, and its lines are not tracked.
    """
    content = read_content(path)
    if content.lstrip().startswith(b"{"):
        with suppress(ValueError, RecursionError):
            data = json.loads(content)
            if is_result(data):
                return FileData(str(path), data, {})
    return parse_yaml(content, str(path))


def linked(
    document: FileData, key: str, folder: Path, expected: str
) -> tuple[FileData | None, tuple[Path, ...], list[Issue]]:
    """The value of a key: a mapping, or the document in the file that it names.

    None if it cannot be read, with all issues; and the file that it is in, if it is another.
    expected: what the key should hold, for the message.
    """
    given = document.data[key]
    if isinstance(given, dict):
        return document.section(key), (), []
    if not isinstance(given, str) or not given:
        message = f"Read {shown(given)}. Expected {expected}."
        return None, (), [document.error((key,), message)]
    named = folder / given
    try:
        return read_document(named), (named,), []
    except InvalidFileError as error:
        # Issues with the name are reported where it is written.
        message = f"Read {shown(given)}. {error.issues[0].message}"
        if error.issues[0].line is None:
            return None, (named,), [document.error((key,), message)]
        return None, (named,), list(error.issues)


def fingerprint(paths: Iterable[Path]) -> str:
    """SHA-256, in hex, over the bytes of files. Raises InvalidFileError if one is unreadable.

    Each is preceded by its length, so that concatenations are unambiguous.
    """
    digest = hashlib.sha256()
    for path in paths:
        content = read_content(path, LONG)
        digest.update(f"{len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def problem_path(path: Path) -> Path:
    """The problem file of a folder; any other path as it is."""
    return _inside(path, "problem.yaml")


EXPERIMENT = "experiment.yaml"


def experiment_path(path: Path) -> Path:
    """The experiment file of a folder; any other path as it is."""
    return _inside(path, EXPERIMENT)


def recording_path(path: Path) -> Path:
    """The first file of a ROS 2 bag's folder; any other path as it is."""
    with suppress(OSError, ValueError):
        if (path / "metadata.yaml").is_file() and not (path / EXPERIMENT).exists():
            return min((*path.glob("*.mcap"), *path.glob("*.db3")), default=path)
    return path


def _inside(path: Path, name: str) -> Path:
    try:
        return path / name if path.is_dir() else path
    except (OSError, ValueError):
        return path


SHORT = 1_000_000
"""Largest YAML file or result, bytes."""
LONG = 250_000_000
"""Largest recording, bytes: over an hour of a dozen markers at 200 Hz as text."""


_AT_ONCE = getattr(os, "O_NONBLOCK", 0)


def read_content(path: Path, most: int = SHORT) -> bytes:
    """The bytes of a regular file. Raises InvalidFileError if it is not one, or exceeds `most`."""
    file = str(path)
    try:
        # Opened in non-blocking mode: a pipe without a writer would block forever.
        with open(file, "rb", opener=lambda name, flags: os.open(name, flags | _AT_ONCE)) as opened:
            why = _not_regular(os.fstat(opened.fileno()).st_mode)
            content = b"" if why else opened.read(most + 1)
    except (OSError, ValueError) as error:
        refuse(file, _why(error))
    if why:
        refuse(file, why)
    if len(content) > most:
        refuse(
            file,
            f"The file is larger than {most / 1e6:g} MB. Expected at most that. "
            "Check that it is the right file, or cut it.",
        )
    return content


def unreadable(path: Path) -> str:
    """Why the file at a path cannot be read, as far as visible without opening it; else empty."""
    try:
        return _not_regular(path.stat().st_mode)
    except (OSError, ValueError) as error:
        return _why(error)


def _why(error: OSError | ValueError) -> str:
    if isinstance(error, FileNotFoundError):
        return "There is no such file. Check its name and folder."
    if isinstance(error, IsADirectoryError):
        return _not_regular(stat.S_IFDIR)
    why = getattr(error, "strerror", None) or error
    return f"The file cannot be read: {why}. Check its name and permissions."


def _not_regular(mode: int) -> str:
    return "" if stat.S_ISREG(mode) else f"This is {kind_of(mode)}. Expected a file."


def kind_of(mode: int) -> str:
    """The kind of a file that is not regular, by its mode."""
    kinds = {
        stat.S_IFLNK: "a symbolic link",
        stat.S_IFDIR: "a folder",
        stat.S_IFIFO: "a pipe",
        stat.S_IFSOCK: "a socket",
    }
    return kinds.get(stat.S_IFMT(mode), "a device")


def require_regular(path: Path) -> None:
    """Raise InputError for an existing path that is not a regular file, before writing to it."""
    try:
        mode = path.lstat().st_mode
    except OSError:
        return
    if not stat.S_ISREG(mode):
        raise InputError(
            f"{path} is {kind_of(mode)}. Expected a regular file, which is replaced, or a new "
            "name. Give another place with --out."
        )
