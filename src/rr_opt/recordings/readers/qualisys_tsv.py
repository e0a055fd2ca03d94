"""The TSV of Qualisys Track Manager, 3D or 6D: keys with values, then a row a frame, in mm.

`MARKER_NAMES` names three columns each, `BODY_NAMES` sixteen: place, three angles, a residual and
the rotation matrix, column by column. The row `Frame`, `Time`, ... and these two columns are
there if the export was set to write them; else frames come at `FREQUENCY`.
"""

import numpy as np

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import (
    MarkerData,
    count_notice,
    frames_of,
    marker_data,
    rate_in,
)
from rr_opt.recordings.readers.text import Reader, ReadOptions, Text, cells_of, read_table


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file begins with the number of its frames."""
    return text.lines[0].startswith("NO_OF_FRAMES\t")


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The markers, or the rigid bodies, of a TSV of Qualisys. Raises InvalidFileError."""
    stated: dict[str, list[str]] = {}
    at = 0
    while at < len(text.lines) and text.lines[at][:1].isalpha():
        key, *values = cells_of(text.lines[at], "\t")
        if key == "Frame":
            break
        stated[key] = [value for value in values if value]
        at += 1
    bodies = [] if stated.get("MARKER_NAMES") else stated.get("BODY_NAMES", [])
    names, parts = (bodies, _BODY) if bodies else (stated.get("MARKER_NAMES", []), [*"XYZ"])
    if not names:
        included = " ".join(stated.get("DATA_INCLUDED", [])) or "nothing"
        refuse(
            file,
            f"Read {shown(included)} as DATA_INCLUDED, without MARKER_NAMES or BODY_NAMES. "
            "Expected 3D or 6D data. Export the markers.",
            at,
        )
    titled = at < len(text.lines) and text.lines[at].startswith("Frame")
    first = at + titled
    timed = titled or (
        first < len(text.lines) and text.lines[first].count("\t") >= len(parts) * len(names) + 1
    )
    columns = ["Frame", "Time"] * timed + [f"{axis} of {name}" for name in names for axis in parts]
    table = read_table(text, first, len(text.lines), "\t", columns)
    frame = (
        frames_of(table, 0, file, len(text.lines))
        if timed or not len(table.values)
        else np.arange(1, len(table.values) + 1)
    )
    values = table.values[:, 2 * timed :].reshape(len(frame), len(names), len(parts))
    turned = None
    if bodies:
        turned = np.swapaxes(values[..., 7:].reshape(len(frame), len(names), 3, 3), 2, 3)
        # A body that was not seen has zeros all over.
        turned[np.abs(np.linalg.det(np.nan_to_num(turned)) - 1) > _RIGID] = np.nan
    return marker_data(
        {"file": file, "format": READER.format, "encoding": text.encoding},
        frame=frame,
        lines=table.lines,
        t=table.values[:, 1] if timed else None,
        rate=rate_in("".join(stated.get("FREQUENCY", [])), "as FREQUENCY", file),
        labels=names,
        positions=values[..., :3],
        rotations=turned,
        unit="mm",
        unit_place=("the export", None),
        doubts=[*table.doubts, *count_notice("".join(stated.get("NO_OF_FRAMES", [])), frame)],
    )


_BODY = ["X", "Y", "Z", "Roll", "Pitch", "Yaw", "Residual", *(f"Rot[{n}]" for n in range(9))]
_RIGID = 0.01
"""How far the determinant of a rotation, printed with five digits, may be from 1."""

READER = Reader("Qualisys TSV", sniff, read)
