"""Files that are either whole or not there, and JSON that every reader accepts.

Each file is written beside its place under another name, flushed to the disk and then moved
over it in one step; a run that is stopped leaves what was there before.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rr_opt.outcome import InputError


def folder_for_results(folder: Path) -> Path:
    """The folder, made if it is missing. Raises InputError if it cannot be one to write to."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"The folder {folder} cannot be made: {error.strerror}. Give another one with --out."
        ) from None
    if not os.access(folder, os.W_OK):
        raise InputError(f"The folder {folder} cannot be written to. Give another one with --out.")
    return folder


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """A temporary path of the same ending, in the same folder, that becomes `path` on success."""
    handle, name = tempfile.mkstemp(suffix=path.suffix, prefix=f".{path.stem}-", dir=path.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        with temporary.open("rb") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_bytes(path: Path, content: bytes) -> Path:
    """Write a file whole."""
    with whole(path) as temporary:
        temporary.write_bytes(content)
    return path


def write_text(path: Path, text: str) -> Path:
    """Write a text file whole, in UTF-8 with newlines as given."""
    return write_bytes(path, text.encode())


def strict_json(data: Mapping[str, Any]) -> str:
    """The data as JSON text with a newline at its end; raises ValueError for NaN or infinity."""
    return json.dumps(data, indent=2, allow_nan=False, ensure_ascii=False) + "\n"


def write_json(path: Path, data: Mapping[str, Any]) -> Path:
    """Write data as strict JSON, whole."""
    return write_text(path, strict_json(data))


def remove(folder: Path, names: Iterable[str]) -> None:
    """Remove the named files of an earlier run, so that none is taken for one of this run."""
    for name in names:
        (folder / name).unlink(missing_ok=True)
