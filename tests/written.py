"""Files written from text or bytes to a folder that the test owns."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

Write = Callable[..., Path]


def writer(folder: Path, default: str) -> Write:
    """Writes a text or bytes to a file of the folder; default: its name, if none is given."""

    def to_file(content: str | bytes, name: str = default) -> Path:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return to_file
