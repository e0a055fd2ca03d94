"""The one gate between rr-opt and the disk: regular files only, and no more than can be held.

A pipe or a device may never end, and what stands behind a link is somebody else's. Input may come
by way of a link; output never replaces or follows one.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from rr_opt.files.issue import refuse
from rr_opt.outcome import InputError

SHORT = 1_000_000
"""Largest YAML file or result, bytes."""
LONG = 250_000_000
"""Largest recording, bytes: over an hour of a dozen markers at 200 Hz as text."""


def read_content(path: Path, most: int = SHORT) -> bytes:
    """The bytes of a regular file. Raises InvalidFileError if it is none, or larger than `most`."""
    file = str(path)
    try:
        # Opened without waiting: a pipe without a writer would be waited for without end.
        with open(file, "rb", opener=_opened) as opened:
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
    """Why the file at a path cannot be read, as far as it shows without opening it; else empty."""
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


def _opened(file: str, flags: int) -> int:
    return os.open(file, flags | getattr(os, "O_NONBLOCK", 0))


def kind_of(mode: int) -> str:
    """What a file that is not regular is, by its mode."""
    kinds = {
        stat.S_IFLNK: "a symbolic link",
        stat.S_IFDIR: "a folder",
        stat.S_IFIFO: "a pipe",
        stat.S_IFSOCK: "a socket",
    }
    return kinds.get(stat.S_IFMT(mode), "a device")


def require_regular(path: Path) -> None:
    """Raise InputError for what exists and is not a regular file, before it is written to."""
    try:
        mode = path.lstat().st_mode
    except OSError:
        return
    if not stat.S_ISREG(mode):
        raise InputError(
            f"{path} is {kind_of(mode)}. Expected a regular file, which is replaced, or a new "
            "name. Give another place with --out."
        )
