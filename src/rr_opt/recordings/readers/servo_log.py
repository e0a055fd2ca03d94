"""The servo's log as CSV: a header row `t,goal,present`, then a row a control step, in counts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.messages import shown
from rr_opt.model.experiment import CountScale
from rr_opt.recordings.readers.text import Text, check_columns, find_header, read_table, refuse
from rr_opt.recordings.time_axis import in_order, rate_of, time_doubts


@dataclass(frozen=True)
class ServoLog:
    """A servo's log of n rows, on the servo's own clock.

    name            of the file
    t               (n,), s, increasing, on the servo's clock, which is not the capture's
    goal, present   (n,), counts as in the file, NaN where empty; None: the file has no such column
    goal_angle      (n,), rad, phi as commanded: (goal - zero) times the angle of a count; or None
    present_angle   (n,), rad, phi as the servo's own encoder had it; or None
    resolution      the angle of one count, rad
    rate            rows per second, Hz, as the times have it
    source          where it came from, plain text by name
    doubts          sentences on what looked wrong and what was made of it
    """

    name: str
    t: Array
    goal: Array | None
    present: Array | None
    goal_angle: Array | None
    present_angle: Array | None
    resolution: float
    rate: float
    source: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    doubts: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.t)


_POSITIONS = ("goal", "present")


def servo_log_from_csv(text: Text, name: str, scale: CountScale | None = None) -> ServoLog:
    """The log of a CSV with a column `t` (s) and at least one of `goal` and `present` (counts).

    Positions of rows that stood in another place than their time, or share it with a row that
    says something else, are NaN. Raises InvalidFileError.
    """
    scale = scale or CountScale()
    header = find_header(text)
    if header is None:
        refuse(text.file, "The file holds no rows. Expected `t,goal,present`. Export it once more.")
    needed = [one for one in _POSITIONS if one in header.names] or list(_POSITIONS)
    columns = check_columns(header, ("t", *needed), ("t", *_POSITIONS), text.file)
    table = read_table(text, header.at + 1, len(text.lines), header.separator, header.names)
    others = [one for one in header.names if one not in ("t", *_POSITIONS)]
    doubts = list(table.doubts)
    if others:
        doubts.append(f"Columns that were not read: {shown(', '.join(others))}.")
    t = table.values[:, columns["t"]]
    values = table.values[:, [columns[one] for one in needed]]
    order = in_order(t, values, table.lines)
    t, values = t[order.rows], values[order.rows]
    values[order.moved | order.unsure] = np.nan
    rate = rate_of(t, text.file, header.at + 1)
    outside = (values < 0) | (values >= scale.counts)
    if outside.any():
        doubts.append(
            f"{outside.sum()} positions lie outside 0 to {scale.counts - 1} counts: is the scale "
            "that of this servo?"
        )
    counts = dict(zip(needed, values.T.copy(), strict=True))
    angles = {one: (read - scale.zero) * scale.each for one, read in counts.items()}
    return ServoLog(
        name=name,
        t=t,
        goal=counts.get("goal"),
        present=counts.get("present"),
        goal_angle=angles.get("goal"),
        present_angle=angles.get("present"),
        resolution=abs(scale.each),
        rate=rate,
        source=MappingProxyType(
            {
                "file": text.file,
                "format": "servo log CSV",
                "encoding": text.encoding,
                "rate": f"{rate:.6g} Hz",
                "clock": "the servo's own t",
                "scale": f"{scale.counts} counts over {math.degrees(scale.range):.6g} degrees, "
                f"phi = 0 at {scale.zero:g}",
            }
        ),
        doubts=(*doubts, *order.doubts, *time_doubts(t, rate)),
    )
