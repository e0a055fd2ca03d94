"""The bytes of a recording's file, and its lines as text whatever its encoding."""

from __future__ import annotations

import codecs
import stat
from dataclasses import dataclass
from pathlib import Path

from rr_opt.recordings.refusal import refuse

_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
"""Byte order marks; that of UTF-32 begins with that of UTF-16, so it is looked for first."""

_BLOCK = 4096


@dataclass(frozen=True)
class Text:
    """A text file.

    file   as the user named it
    lines  without their ends; the first has the number 1 in messages
    ended  whether the last line that holds something has a line end
    """

    file: str
    encoding: str
    lines: list[str]
    ended: bool


def read_bytes(path: Path) -> bytes:
    """The content of a file. Raises InvalidFileError if there is none that could be read."""
    try:
        # A pipe or a device may never end.
        if not stat.S_ISREG(path.stat().st_mode):
            what = "a folder" if path.is_dir() else "no regular file"
            refuse(str(path), f"This is {what}. Expected the file of a recording. Name the file.")
        content = path.read_bytes()
    except FileNotFoundError:
        refuse(str(path), "There is no such file. Check its name and folder.")
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        refuse(str(path), f"The file cannot be read: {why}. Check its name and permissions.")
    if not content.strip():
        refuse(str(path), "The file is empty. Expected a recording. Export it once more.")
    return content


def decode(content: bytes, file: str) -> Text:
    """The text of a file: UTF-8 or UTF-16 with or without a mark, or Latin-1.

    Raises InvalidFileError for what is no text.
    """
    encoding = _encoding(content)
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        refuse(file, f"The text is not {encoding.upper()}. Save the file as UTF-8.", line)
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        refuse(
            file,
            "Read a byte 0, which no text has. Expected CSV, C3D, TRC or netCDF. The file may be "
            "damaged, or of another format: export it once more.",
            line,
        )
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    return Text(file, encoding.removesuffix("-sig"), text.split("\n"), text.endswith("\n"))


def _encoding(content: bytes) -> str:
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return encoding
    head = content[:_BLOCK]
    # In UTF-16 every second byte of plain English and of numbers is 0.
    for start, encoding in ((1, "utf-16-le"), (0, "utf-16-be")):
        half = head[start::2]
        if len(half) > 4 and half.count(0) > 0.9 * len(half):
            return encoding
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"
