"""Files of recordings, read by their content; each format is a module here with a READER."""

from pathlib import Path
from typing import NoReturn

from rr_opt.files.issue import refuse
from rr_opt.files.source import LONG, read_content
from rr_opt.messages import shown
from rr_opt.model.experiment import Recording
from rr_opt.recordings.readers import (
    c3d,
    motive_csv,
    netcdf,
    plain_csv,
    qualisys_tsv,
    ros_bag,
    trc,
    vicon_csv,
)
from rr_opt.recordings.readers.marker_rows import MarkerData
from rr_opt.recordings.readers.plain_csv import ServoLog
from rr_opt.recordings.readers.text import Reader, ReadOptions, Text, decode, find_header

__all__ = ["READERS", "MarkerData", "ReadOptions", "ServoLog", "read_file"]

READERS: tuple[Reader, ...] = (
    c3d.READER,
    netcdf.READER,
    ros_bag.READER,
    trc.READER,
    motive_csv.READER,
    qualisys_tsv.READER,
    vicon_csv.READER,
    plain_csv.LOG,
    plain_csv.MOTION,
)
"""In the order in which they are tried on a file."""


def read_file(
    path: str | Path, options: ReadOptions | None = None
) -> Recording | MarkerData | ServoLog:
    """What a file holds: motion, markers, or a servo's log.

    Raises InvalidFileError with file, line and column of what is wrong, and InputError if an extra
    that the format needs is not installed.
    """
    file, options = str(path), options or ReadOptions()
    content = read_content(Path(path), LONG)
    if not content.strip():
        refuse(file, "The file is empty. Expected a recording. Export it again.")
    for reader in READERS:
        if reader.binary and reader.sniff(content):
            return reader.read(file, content, options)
    text = decode(content, file)
    del content  # an hour of markers is large
    for reader in READERS:
        if not reader.binary and reader.sniff(text, options):
            return reader.read(file, text, options)
    _refuse(text)


def _refuse(text: Text) -> NoReturn:
    """Raise InvalidFileError for a file of no known kind."""
    header = find_header(text)
    names = header.names if header else ()
    # A line without columns is not quoted: the file may be any file.
    first = shown(text.lines[header.at]) if header and len(names) > 1 else "a line without columns"
    advice = "Check that it is a recording."
    if "endheader" in "\n".join(text.lines[:20]).casefold():
        advice = "It looks like an OpenSim table: export C3D or TRC instead."
    elif names and all(name.replace(".", "").lstrip("+-").isdecimal() for name in names):
        advice = "The first row has numbers: write the header row `t,x,y,psi,phi` above it."
    formats = ", ".join(reader.format for reader in READERS[:-2])
    refuse(
        text.file,
        f"Read {first}. Expected a header row such as `t,x,y,psi,phi` or `t,goal,present`, "
        f"or one of: {formats}. {advice}",
        header.at + 1 if header else 1,
    )
