"""What a recording's file is, told from its content and not from its name."""

from __future__ import annotations

from typing import Literal

from rr_opt.experiment.recording import CHANNELS
from rr_opt.files.issue import shown
from rr_opt.recordings.c3d import is_c3d
from rr_opt.recordings.header import find_header
from rr_opt.recordings.netcdf import SIGNATURE
from rr_opt.recordings.refusal import refuse
from rr_opt.recordings.text import Text
from rr_opt.recordings.trc import is_trc
from rr_opt.recordings.vicon_csv import is_vicon

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
