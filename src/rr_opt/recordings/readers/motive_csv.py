"""The CSV of OptiTrack Motive: a line of keys and values, the header's rows, then a row a frame.

The header has a row each for the type of what a column belongs to (`Marker`, `Rigid Body`, ...),
its name, as a rule its ID, `Position` or `Rotation`, and last `Frame,Time (Seconds),X,Y,Z,...`.
The markers that were measured are read, or else the poses of two rigid bodies; `Rigid Body Marker`
is where Motive's own fit has them.
Motive's y axis points up unless set otherwise: `up: y`.
"""

import numpy as np

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import (
    MarkerData,
    frames_of,
    marker_data,
    matrices,
    rate_in,
)
from rr_opt.recordings.readers.text import Reader, ReadOptions, Text, cells_of, read_table
from rr_opt.recordings.warnings import notice

_HEADER = 12
"""The header has fewer lines than this."""
_ROUNDED = 1e-3
"""Within this, s, a time is that of its frame."""


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file begins with the version of its format."""
    return text.lines[0].startswith("Format Version,")


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The measured markers, else the rigid bodies, of a CSV of Motive. Raises InvalidFileError."""
    words = cells_of(text.lines[0], ",")
    stated = dict(zip(words[::2], words[1::2], strict=False))
    header = [cells_of(line, ",") for line in text.lines[:_HEADER]]
    last = next((at for at, cells in enumerate(header) if cells[0] == "Frame"), None)
    if last is None or len(header[last]) < 2 or not header[last][1].startswith("Time"):
        refuse(
            file,
            "Read no row `Frame,Time (Seconds),X,Y,Z,...`. Expected it below the header. Export it "
            "again.",
            min(len(header), _HEADER),
        )
    axes = header[last]
    width = len(axes)
    padded = [[*cells, *[""] * width][:width] for cells in header[1:last]]
    kinds = next((cells for cells in padded if {"Marker", "Rigid Body"} & set(cells)), [""] * width)
    named = padded.index(kinds) + 1 if kinds in padded else 0
    measures = next((cells for cells in padded if "Position" in cells), [""] * width)

    def triples(kind: str, measure: str) -> list[int]:
        """Where the three columns of every such place, or rotation, begin."""
        return [
            at
            for at in range(2, width - 2)
            if (kinds[at], measures[at], axes[at : at + 3]) == (kind, measure, [*"XYZ"])
        ]

    kind = "Marker" if triples("Marker", "Position") else "Rigid Body"
    places, turns = triples(kind, "Position"), triples(kind, "Rotation")
    if not places or named >= len(padded) or (kind == "Rigid Body" and len(turns) != len(places)):
        found = ", ".join(dict.fromkeys(one for one in kinds[2:] if one)) or "nothing"
        refuse(
            file,
            f"Read columns of {shown(found)}. Expected positions of the type `Marker`, or "
            "positions and rotations of the type `Rigid Body`. Export the markers.",
            last + 1,
        )
    columns = [
        None if axis == "TimeCode" else f"{axis} {name}".strip()
        for axis, name in zip(axes, padded[named], strict=True)
    ]
    table = read_table(text, last + 1, len(text.lines), ",", columns)
    doubts = list(table.doubts)
    others = [one for one in dict.fromkeys(kinds[2:]) if one not in ("", kind)]
    if others:
        doubts.append(notice("file.columns", names=shown(", ".join(others))))
    rate = stated.get("Export Frame Rate") or stated.get("Capture Frame Rate", "")
    frame, hertz = frames_of(table, 0, file, last + 1), rate_in(rate, "as the frame rate", file, 1)
    t = table.values[:, 1]
    # Times may be written to the millisecond, which frames are not.
    counted = frame / hertz
    turned = None
    if kind == "Rigid Body":
        order = stated.get("Rotation Type", "Quaternion").upper()
        count = 4 if order == "QUATERNION" else 3
        if count == 3 and sorted(order) != [*"XYZ"]:
            refuse(file, f"Read the Rotation Type {shown(order)}. Expected Quaternion or XYZ.", 1)
        turned = np.stack([table.values[:, at : at + count] for at in turns], axis=1)
        turned = matrices(turned if count == 4 else np.radians(turned), order)
    return marker_data(
        {"file": file, "format": READER.format, "encoding": text.encoding},
        frame=frame,
        lines=table.lines,
        t=counted if np.abs(counted - t).max(initial=0.0) < _ROUNDED else t,
        rate=hertz,
        labels=[padded[named][at] for at in places],
        positions=np.stack([table.values[:, at : at + 3] for at in places], axis=1),
        rotations=turned,
        unit=stated.get("Length Units", ""),
        unit_place=("`Length Units`", 1),
        up="y",
        doubts=doubts,
    )


READER = Reader("OptiTrack Motive CSV", sniff, read)
