"""The results that rr-opt writes, told apart from input files and read as the JSON they are."""

from __future__ import annotations

import json

from rr_opt.files.document import Document

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
