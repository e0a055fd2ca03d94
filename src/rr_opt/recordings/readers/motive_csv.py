"""The CSV of OptiTrack Motive: a line of keys and values, the header's rows, then a row a frame.

The header has a row each for the type of what a column belongs to (`Marker`, `Rigid Body`, ...),
its name, as a rule its ID, `Position` or `Rotation`, and last `Frame,Time (Seconds),X,Y,Z,...`.
The markers that were measured are read; `Rigid Body Marker` is where Motive's own fit has them.
Motive's y axis points up unless it was told otherwise: `up: y`.
"""

from __future__ import annotations

import numpy as np

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import MarkerData, frames_of, marker_data, rate_in
from rr_opt.recordings.readers.text import Reader, ReadOptions, Text, cells_of, read_table
from rr_opt.recordings.warnings import notice

_HEADER = 12
"""The header has fewer lines than this."""


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file begins with the version of its format."""
    return text.lines[0].startswith("Format Version,")


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The measured markers of a CSV of Motive. Raises InvalidFileError."""
    words = cells_of(text.lines[0], ",")
    stated = dict(zip(words[::2], words[1::2], strict=False))
    header = [cells_of(line, ",") for line in text.lines[:_HEADER]]
    last = next((at for at, cells in enumerate(header) if cells[0] == "Frame"), None)
    if last is None or len(header[last]) < 2 or not header[last][1].startswith("Time"):
        refuse(
            file,
            "Read no row `Frame,Time (Seconds),X,Y,Z,...`. Expected it below the header. "
            "Export it once more.",
            min(len(header), _HEADER),
        )
    axes = header[last]
    width = len(axes)
    padded = [[*cells, *[""] * width][:width] for cells in header[1:last]]
    kinds = next((cells for cells in padded if {"Marker", "Rigid Body"} & set(cells)), [""] * width)
    named = padded.index(kinds) + 1 if kinds in padded else 0
    measures = next((cells for cells in padded if "Position" in cells), [""] * width)
    places = [
        at
        for at in range(2, width - 2)
        if kinds[at] == "Marker" and measures[at] == "Position" and axes[at : at + 3] == [*"XYZ"]
    ]
    if not places or named >= len(padded):
        found = ", ".join(dict.fromkeys(one for one in kinds[2:] if one)) or "nothing"
        refuse(
            file,
            f"Read columns of {shown(found)}. Expected positions of the type `Marker`: poses of "
            "rigid bodies do not say where the joint is. Export the markers.",
            last + 1,
        )
    columns = [
        None if axis == "TimeCode" else f"{axis} {name}".strip()
        for axis, name in zip(axes, padded[named], strict=True)
    ]
    table = read_table(text, last + 1, len(text.lines), ",", columns)
    doubts = list(table.doubts)
    others = [one for one in dict.fromkeys(kinds[2:]) if one not in ("", "Marker")]
    if others:
        doubts.append(notice("file.columns", names=shown(", ".join(others))))
    rate = stated.get("Export Frame Rate") or stated.get("Capture Frame Rate", "")
    return marker_data(
        {"file": file, "format": READER.format, "encoding": text.encoding},
        frame=frames_of(table, 0, file, last + 1),
        lines=table.lines,
        t=table.values[:, 1],
        rate=rate_in(rate, "as the frame rate", file, 1),
        labels=[padded[named][at] for at in places],
        positions=np.stack([table.values[:, at : at + 3] for at in places], axis=1),
        unit=stated.get("Length Units", ""),
        unit_place=("`Length Units`", 1),
        up="y",
        doubts=doubts,
    )


READER = Reader("OptiTrack Motive CSV", sniff, read)
