"""TRC, Track Row Column: markers as text, tabs between the cells.

Line 1 begins with `PathFileType`. Line 2 names what line 3 holds: DataRate, NumMarkers, Units and
others. Line 4 is `Frame#`, `Time` and each marker's name above the first of its columns, line 5 has
X1, Y1, Z1, X2 and so on. Rows follow, as a rule after a blank line.
"""

from __future__ import annotations

import math

import numpy as np

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import MarkerData, MarkerRows, marker_data
from rr_opt.recordings.readers.text import (  # fmt: skip
    Reader,
    ReadOptions,
    Text,
    cells_of,
    read_table,
    separator_of,
)
from rr_opt.recordings.warnings import Notice, notice


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file begins as every TRC file does."""
    return text.lines[0].lstrip().startswith("PathFileType")


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The markers of a TRC file. Raises InvalidFileError."""
    if len(text.lines) < 6:
        refuse(
            text.file,
            "The file ends within its header. Expected five lines of header and then rows. "
            "Export it once more.",
            len(text.lines),
        )
    stated = _stated(text)
    separator = separator_of(text.lines[3])
    head = cells_of(text.lines[3], separator)
    if [cell.casefold() for cell in head[:2]] != ["frame#", "time"]:
        refuse(
            text.file,
            f"Read {shown(text.lines[3])}. Expected `Frame#`, `Time` and the markers' names. "
            "Export it once more.",
            4,
        )
    names, doubts = _names(text, head, stated, separator)
    columns = ["Frame#", "Time", *(f"{axis} of {one}" for one in names for axis in "XYZ")]
    table = read_table(text, 5, len(text.lines), separator, columns)
    if not len(table.values):
        refuse(text.file, "The file has no rows. Export the whole recording.", 5)
    frames = table.values[:, 0]
    whole = np.isfinite(frames) & (np.abs(frames) < 2**53)
    if not whole.all():
        line = int(table.lines[np.flatnonzero(~whole)[0]])
        refuse(text.file, "Read no number of a frame. Expected one in column 1.", line)
    rows = MarkerRows(
        frame=np.round(frames).astype(np.int64),
        t=table.values[:, 1],
        rate=_rate(text, stated),
        labels=tuple(names),
        positions=table.values[:, 2:].reshape(len(frames), len(names), 3),
        unit=stated.get("units", ""),
        unit_place=("`Units`", 3),
        lines=table.lines,
    )
    said = stated.get("numframes", "")
    if said.isdecimal() and int(said) != len(frames):
        doubts.append(notice("file.frames", stated=int(said), count=len(frames)))
    source = {"file": file, "format": "TRC", "encoding": text.encoding}
    return marker_data(rows, source, [*table.doubts, *doubts])


def _stated(text: Text) -> dict[str, str]:
    """What lines 2 and 3 say, by the name in small letters."""
    separator = separator_of(text.lines[1])
    keys = [cell.casefold() for cell in cells_of(text.lines[1], separator)]
    return dict(zip(keys, cells_of(text.lines[2], separator), strict=False))


def _rate(text: Text, stated: dict[str, str]) -> float:
    cell = stated.get("datarate", "")
    try:
        rate = float(cell.replace(",", "."))
    except ValueError:
        rate = math.nan
    if not 0 < rate < math.inf:
        refuse(
            text.file,
            f"Read {shown(cell)} as DataRate. Expected the rate in Hz in line 3, under the name in "
            "line 2. Correct it.",
            3,
        )
    return rate


def _names(
    text: Text, head: list[str], stated: dict[str, str], separator: str
) -> tuple[list[str], list[Notice]]:
    """The markers' names, and what is odd about them: one above each X, every third column."""
    axes = [cell for cell in cells_of(text.lines[4], separator)[2:] if cell]
    count = max(len(axes) // 3, 1)
    every_third = [head[at] if at < len(head) else "" for at in range(2, 2 + 3 * count, 3)]
    together = [cell for cell in head[2:] if cell]
    # Some programs write the names side by side, without the empty cells between them.
    names = every_third if all(every_third) or len(together) != count else together
    said = stated.get("nummarkers", "")
    if said.isdecimal() and int(said) != count:
        return names, [notice("file.markers", stated=int(said), count=count)]
    return names, []


READER = Reader("TRC", sniff, read)
