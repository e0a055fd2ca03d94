"""Any file of a recording, read by what it holds."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from rr_opt.messages import shown
from rr_opt.model.experiment import CHANNELS, CountScale, Noise, Recording
from rr_opt.recordings.readers.c3d import is_c3d, markers_from_c3d
from rr_opt.recordings.readers.marker_rows import MarkerData
from rr_opt.recordings.readers.netcdf import SIGNATURE, read_netcdf
from rr_opt.recordings.readers.plain_csv import recording_from_csv
from rr_opt.recordings.readers.servo_log import ServoLog, servo_log_from_csv
from rr_opt.recordings.readers.text import Text, decode, find_header, read_bytes, refuse
from rr_opt.recordings.readers.trc import is_trc, markers_from_trc
from rr_opt.recordings.readers.vicon_csv import is_vicon, markers_from_vicon

BinaryKind = Literal["c3d", "netcdf"]
TextKind = Literal["plain", "servo", "vicon", "trc"]

_NETCDF3 = (b"CDF\x01", b"CDF\x02", b"CDF\x05")

_FOREIGN = {
    "format version": "a CSV of OptiTrack Motive",
    "no_of_frames": "a TSV of Qualisys QTM",
    "endheader": "a table of OpenSim",
}
"""Beginnings of files that are known and not read."""


def binary_kind(content: bytes, file: str) -> BinaryKind | None:
    """The kind of a file that is no text. Raises InvalidFileError for netCDF of an older kind."""
    if content.startswith(SIGNATURE):
        return "netcdf"
    if content.startswith(_NETCDF3):
        refuse(file, "This is netCDF 3. Expected netCDF 4. Convert it with `nccopy -k nc4`.")
    return "c3d" if is_c3d(content) else None


def text_kind(text: Text) -> TextKind:
    """The kind of a text file. Raises InvalidFileError if it is none that is read."""
    if is_trc(text):
        return "trc"
    if is_vicon(text):
        return "vicon"
    header = find_header(text)
    names = set(header.names) if header else set()
    if names & {"goal", "present"} and not names & set(CHANNELS):
        return "servo"
    if "t" in names or len(names & set(CHANNELS)) > 1:
        return "plain"
    first = text.lines[header.at] if header else ""
    foreign = next((what for mark, what in _FOREIGN.items() if mark in first.casefold()), "")
    advice = "Check that it is a recording."
    if foreign:
        advice = f"It looks like {foreign}: export C3D or TRC instead."
    elif _looks_like_numbers(header.names if header else ()):
        advice = "The first row holds numbers: write the header row `t,x,y,psi,phi` above it."
    refuse(
        text.file,
        f"Read {shown(first)}. Expected a header row such as `t,x,y,psi,phi` or `t,goal,present`, "
        f"a Vicon Nexus CSV, TRC, C3D or netCDF. {advice}",
        header.at + 1 if header else 1,
    )


def _looks_like_numbers(names: tuple[str, ...]) -> bool:
    return bool(names) and all(name.replace(".", "").lstrip("+-").isdecimal() for name in names)


def read_file(
    path: str | Path, noise: Noise | None = None, scale: CountScale | None = None
) -> Recording | MarkerData | ServoLog:
    """What a file holds: motion (plain CSV, netCDF), markers (Vicon CSV, C3D, TRC), a servo's log.

    noise: of motion that does not state its own; scale: of a servo's counts. Raises
    InvalidFileError with file, line and column of what is wrong, and InputError if an extra that
    the format needs is not installed.
    """
    path = Path(path)
    content = read_bytes(path)
    binary = binary_kind(content, str(path))
    if binary == "c3d":
        return markers_from_c3d(content, str(path), path.name)
    if binary == "netcdf":
        return read_netcdf(path, noise)
    text = decode(content, str(path))
    del content
    kind = text_kind(text)
    if kind == "trc":
        return markers_from_trc(text, path.name)
    if kind == "vicon":
        return markers_from_vicon(text, path.name)
    if kind == "servo":
        return servo_log_from_csv(text, path.name, scale)
    return recording_from_csv(text, path.name, noise)
