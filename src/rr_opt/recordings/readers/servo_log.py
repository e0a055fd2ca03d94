"""The servo's log as CSV: a header row `t,goal,present`, then a row a control step, in counts."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import CHANNELS
from rr_opt.recordings.readers.columns import column_names, read_columns
from rr_opt.recordings.readers.text import Reader, ReadOptions, Text
from rr_opt.recordings.warnings import notice


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


def sniff(text: Text, options: ReadOptions) -> bool:
    """Whether a header row has one of the positions and none of a recording's channels."""
    names = column_names(text, options.columns, ("t", *CHANNELS, *_POSITIONS))
    return bool(names & set(_POSITIONS)) and not names & set(CHANNELS)


def read(file: str, text: Text, options: ReadOptions) -> ServoLog:
    """The log of a CSV with a column `t` (s) and at least one of `goal` and `present` (counts).

    Positions of rows that stood in another place than their time, or share it with a row that
    says something else, are NaN.
    """
    scale = options.counts
    known = ("t", *_POSITIONS)
    names = column_names(text, options.columns, known)
    needed = ("t", *([one for one in _POSITIONS if one in names] or _POSITIONS))
    found = read_columns(text, needed, known, options.columns)
    values = found.values
    values[found.order.moved | found.order.unsure] = np.nan
    doubts = found.doubts
    outside = (values < 0) | (values >= scale.counts)
    if outside.any():
        doubts += (notice("servo.counts", count=outside.sum(), last=scale.counts - 1),)
    counts = dict(zip(found.names, values.T.copy(), strict=True))
    angles = {one: (read - scale.zero) * scale.each for one, read in counts.items()}
    source = {
        **found.source,
        "format": "servo log CSV",
        "clock": "the servo's own t",
        "scale": f"{scale.counts} counts over {math.degrees(scale.range):.6g} degrees, "
        f"phi = 0 at {scale.zero:g}",
    }
    return ServoLog(
        name=Path(file).name,
        t=found.t,
        goal=counts.get("goal"),
        present=counts.get("present"),
        goal_angle=angles.get("goal"),
        present_angle=angles.get("present"),
        resolution=abs(scale.each),
        rate=found.rate,
        source=MappingProxyType(source),
        doubts=doubts,
    )


READER = Reader("servo log CSV", sniff, read)
