"""Where results go: the value of --out."""

from __future__ import annotations

from pathlib import Path

from rr_opt.outcome import InputError


def place(text: str) -> Path:
    """A path that the user named. Raises InputError for no name at all.

    Without this an empty one, as an unset variable of a script leaves it, is the current folder.
    """
    if not text.strip():
        raise InputError(
            "--out: Read an empty name. Expected the name of a folder or a file. "
            "Name one, `.` for the current folder, or leave --out away."
        )
    return Path(text)
