"""The TSV of Qualisys Track Manager with 3D data: keys with values, then a row a frame, in mm.

`MARKER_NAMES` names three columns each. The row `Frame`, `Time`, ... and these two columns are
there if the export was told to write them; else frames come at `FREQUENCY`.
"""

from __future__ import annotations

import math

import numpy as np

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import MarkerData, MarkerRows, marker_data
from rr_opt.recordings.readers.text import Reader, ReadOptions, Text, cells_of, read_table
from rr_opt.recordings.warnings import notice


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file begins with the number of its frames."""
    return text.lines[0].startswith("NO_OF_FRAMES\t")


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The markers of a TSV of Qualisys. Raises InvalidFileError, also for 6D data alone."""
    stated: dict[str, list[str]] = {}
    at = 0
    while at < len(text.lines) and text.lines[at][:1].isalpha():
        key, *values = cells_of(text.lines[at], "\t")
        if key == "Frame":
            break
        stated[key] = [value for value in values if value]
        at += 1
    names = stated.get("MARKER_NAMES", [])
    if not names:
        included = " ".join(stated.get("DATA_INCLUDED", [])) or "nothing"
        refuse(
            file,
            f"Read {shown(included)} as DATA_INCLUDED, without MARKER_NAMES. Expected 3D data: "
            "poses of rigid bodies do not say where the joint is. Export the markers.",
            at,
        )
    titled = at < len(text.lines) and text.lines[at].startswith("Frame")
    first = at + titled
    timed = titled or (
        first < len(text.lines) and text.lines[first].count("\t") >= 3 * len(names) + 1
    )
    columns = ["Frame", "Time"] * timed + [f"{axis} of {name}" for name in names for axis in "XYZ"]
    table = read_table(text, first, len(text.lines), "\t", columns)
    count = len(table.values)
    if not count:
        refuse(file, "The file has no rows. Export the whole recording.", len(text.lines))
    frames = table.values[:, 0] if timed else np.arange(1.0, count + 1)
    wrong = np.flatnonzero(~(np.abs(frames) < 2**53))
    if len(wrong):
        line = int(table.lines[wrong[0]])
        refuse(file, "Read no number of a frame. Expected one in column 1.", line)
    rows = MarkerRows(
        frame=np.round(frames).astype(np.int64),
        t=table.values[:, 1] if timed else None,
        rate=_rate(file, stated),
        labels=tuple(names),
        positions=table.values[:, 2 * timed :].reshape(count, len(names), 3),
        unit="mm",
        unit_place=("the export", None),
        lines=table.lines,
    )
    doubts = list(table.doubts)
    said = "".join(stated.get("NO_OF_FRAMES", []))
    if said.isdecimal() and int(said) != count:
        doubts.append(notice("file.frames", stated=int(said), count=count))
    source = {"file": file, "format": READER.format, "encoding": text.encoding}
    return marker_data(rows, source, doubts)


def _rate(file: str, stated: dict[str, list[str]]) -> float:
    cell = "".join(stated.get("FREQUENCY", []))
    try:
        rate = float(cell.replace(",", "."))
    except ValueError:
        rate = math.nan
    if not 0 < rate < math.inf:
        refuse(file, f"Read {shown(cell)} as FREQUENCY. Expected the rate in Hz. Correct it.")
    return rate


READER = Reader("Qualisys TSV", sniff, read)
