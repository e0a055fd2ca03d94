"""Files that are written whole or not at all, and JSON that every reader accepts.

Each file is written beside its place under another name, flushed to disk and then moved over it
atomically; a run that is stopped leaves the previous file. Only regular files are replaced: a
device, a pipe or a link in the place of a result is rejected and left alone.
"""

import json
import os
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rr_opt.files.source import require_regular
from rr_opt.outcome import InputError


def folder_for_results(folder: Path) -> Path:
    """The folder, created when the first file is written to it.

    Raises InputError if it cannot be written to.
    """
    return _writable(folder, folder)


def file_for_result(file: Path) -> Path:
    """The file, whose folder is created when it is written. Raises InputError if it cannot be."""
    if file.is_dir() and not file.is_symlink():
        raise InputError(f"{file} is a folder. Expected a file. Name one in it with --out.")
    require_regular(file)
    _writable(file, file.parent)
    return file


def _writable(asked: Path, folder: Path) -> Path:
    """`asked`, if files can be written to `folder`, or it can be created."""
    # A dangling link also exists, and no folder can be created in its place.
    existing = next(
        place for place in (folder, *folder.absolute().parents) if os.path.lexists(place)
    )
    if not existing.is_dir():
        raise InputError(
            f"{asked} cannot be made: {existing} is not a folder. Give another place with --out."
        )
    try:
        # Permissions alone do not show that a mount is read-only.
        with tempfile.TemporaryFile(dir=existing):
            pass
    except OSError:
        raise InputError(
            f"{asked} cannot be written: no permission to write to {existing}. "
            "Give another place with --out."
        ) from None
    return asked


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """A temporary path of the same suffix, in the same folder, that becomes `path` on success.

    Missing folders are created, and removed again if nothing is written to them. Raises InputError
    if `path` is neither a regular file nor a new name.
    """
    require_regular(path)
    made = [place for place in (path.parent, *path.parent.parents) if not place.exists()]
    temporary: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(path.suffix, f".{path.stem}-", path.parent)
        temporary = Path(name)
        os.close(handle)
        yield temporary
        with temporary.open("rb") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        for place in made:
            with suppress(OSError):
                place.rmdir()
        raise


def write_bytes(path: Path, content: bytes) -> Path:
    """Write a file atomically."""
    with whole(path) as temporary:
        temporary.write_bytes(content)
    return path


def write_text(path: Path, text: str) -> Path:
    """Write a text file atomically, in UTF-8 with newlines as given."""
    return write_bytes(path, text.encode())


def strict_json(data: Mapping[str, Any]) -> str:
    """The data as JSON text with a newline at its end; raises ValueError for NaN or infinity."""
    text = json.dumps(data, indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    # Put each list of numbers on one line. No string has a line break, so this changes none.
    return re.sub(r'\[\n[^"{}\[\]]+\]', lambda row: f"[{' '.join(row[0][1:-1].split())}]", text)


def write_json(path: Path, data: Mapping[str, Any]) -> Path:
    """Write data as strict JSON, atomically."""
    return write_text(path, strict_json(data))


def netcdf_writer() -> Any:
    """The module xarray. Raises InputError if it, h5netcdf or h5py is not installed."""
    try:
        import h5netcdf  # noqa: F401
        import h5py  # noqa: F401  # pyright: ignore[reportMissingImports]
        import xarray
    except ImportError:
        raise InputError(
            "netCDF files need xarray, h5netcdf and h5py, which are not all installed. "
            "Run `pip install 'rr-opt[netcdf]'`, or write CSV with --format csv."
        ) from None
    return xarray


def write_dataset(path: Path, data: Any) -> Path:
    """Write an xarray dataset, atomically."""
    with whole(path) as temporary:
        data.to_netcdf(temporary, engine="h5netcdf")
    return path


def remove(folder: Path, names: Iterable[str]) -> None:
    """Remove the named files of an earlier run, so that none is mistaken for one of this run.

    Raises InputError, before any is removed, if one is not a regular file.
    """
    paths = [folder / name for name in names]
    for path in paths:
        require_regular(path)
    for path in paths:
        path.unlink(missing_ok=True)
