"""The servo's log as CSV: a header row `t,goal,present`, then a row a control step, in counts."""

from __future__ import annotations

import math
from types import MappingProxyType

import numpy as np

from rr_opt.experiment.count_scale import CountScale
from rr_opt.files.issue import shown
from rr_opt.recordings.header import check_columns, find_header
from rr_opt.recordings.rates import rate_of, time_doubts
from rr_opt.recordings.refusal import refuse
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.recordings.table import read_table
from rr_opt.recordings.text import Text
from rr_opt.recordings.times import in_order

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
