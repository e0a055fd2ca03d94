"""The folder of an inspection: the record, the page, and the recording in netCDF if asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from rr_opt.recordings.inspection import Inspection
from rr_opt.report.archive import remove, whole, write_json, write_text
from rr_opt.report.inspect.record import record

RECORD, PAGE = "inspection.json", "report.html"


def write_inspection(
    name: str,
    sha256: str,
    found: Sequence[Inspection],
    folder: Path,
    *,
    figures: bool,
    progress: Callable[[str], object],
) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    remove(folder, (RECORD, PAGE))
    written = [write_json(folder / RECORD, record(name, sha256, found))]
    if not figures:
        return written
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.inspect.of_inspection import draw  # noqa: PLC0415
    from rr_opt.report.inspect.page import page  # noqa: PLC0415

    drawn = []
    for number, one in enumerate(found, 1):
        progress(f"figures {number} of {len(found)}")
        drawn.append(draw(one))
    return [write_text(folder / PAGE, page(name, sha256, found, drawn)), *written]


def write_recording(path: Path, found: Inspection) -> Path:
    """Write the cleaned recording to a netCDF file, whole. Raises InputError without the extra."""
    from rr_opt.recordings.netcdf import write_netcdf  # noqa: PLC0415

    with whole(path) as temporary:
        write_netcdf(temporary, replace(found.recording, doubts=found.doubts), found.gait)
    return path
