"""Rows of marker positions, as any format has them, to MarkerData."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.time_axis import check_rate, in_order, rate_of, time_notices
from rr_opt.recordings.warnings import Notice, notice


@dataclass(frozen=True)
class MarkerData:
    """Where k markers were seen at n times, in the capture system's frame, third axis up.

    name       of the file
    t          (n,), s, increasing, on the capture's clock; 0 is where the file's own clock has it
    frame      (n,), the frames' numbers as in the file
    labels     (k,), the markers' names, each once
    positions  (n, k, 3), m; NaN where a marker was not seen
    rate       frames per second, Hz, as the file states it; else as the times have it
    residual   (n, k), m, of the capture's own triangulation, NaN where unknown; None: not told
    source     where it came from: file, format, unit, encoding; plain text by name
    doubts     sentences on what looked wrong and what was made of it
    """

    name: str
    t: Array
    frame: NDArray[np.int64]
    labels: tuple[str, ...]
    positions: Array
    rate: float
    residual: Array | None = None
    source: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    doubts: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.t)


_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "dm": 0.1, "in": 0.0254, "inches": 0.0254}
_METRES |= {
    "millimeters": 1e-3,
    "millimetres": 1e-3,
    "centimeters": 1e-2,
    "meters": 1.0,
    "metres": 1.0,
}


@dataclass(frozen=True)
class MarkerRows:
    """Markers as a file has them.

    frame      (n,), lines (n,) numbers of the rows in the file (of frames, if it has no lines)
    t          (n,), s, on the file's clock; None: frame 1 is at 0, and frames come at the rate
    rate       as stated by a header, Hz
    labels     (k,), as written
    positions  (n, k, 3), in `unit`
    unit_place what states the unit, and in which line
    """

    frame: NDArray[np.int64]
    t: Array | None
    rate: float
    labels: tuple[str, ...]
    positions: Array
    unit: str
    unit_place: tuple[str, int | None]
    lines: NDArray[np.int64]
    residual: Array | None = None


def marker_data(
    rows: MarkerRows, source: Mapping[str, str], doubts: Sequence[Notice] = ()
) -> MarkerData:
    """The markers in order of time, in metres, under clean names.

    Exact zeros are missing markers. Of frames that stand there twice and say different things no
    position is kept. Raises InvalidFileError if the unit is not one of length, or the rate not one
    of a recording.
    """
    file = source["file"]
    check_rate(rows.rate, file)
    labels, subject, told = clean_labels(rows.labels)
    doubts = [*doubts, *told]
    scale, told = _scale(rows, file)
    doubts += told
    t = (rows.frame - 1) / rows.rate if rows.t is None else rows.t
    order = in_order(t, rows.positions, rows.lines)
    if not len(order.rows):
        first = int(rows.lines[0]) if len(rows.lines) else None
        refuse(file, "Read no row with a time. Expected one in each. Export it once more.", first)
    positions = rows.positions[order.rows] * scale
    origin = (positions == 0).all(axis=2)
    if origin.any():
        doubts.append(notice("marker.origin", count=origin.sum()))
    positions[origin] = np.nan
    positions[order.unsure] = np.nan
    # A position is there as a whole, or not at all.
    positions[np.isnan(positions).any(axis=2)] = np.nan
    never = [one for one, seen in zip(labels, _seen(positions), strict=True) if not seen]
    if never:
        doubts.append(notice("marker.never", names=", ".join(never)))
    t = t[order.rows]
    rate = rows.rate
    doubts += order.doubts
    if len(t) > 1:
        measured = rate_of(t, file)
        rate = rate if rows.t is None else measured
        doubts += time_notices(t, measured, rows.rate if rows.t is not None else None)
    if len(t) and rows.frame[order.rows][0] != 1 and rows.t is None:
        doubts.append(notice("time.first", frame=rows.frame[order.rows][0], start=t[0]))
    clock = "t = 0 at frame 1" if rows.t is None else "the file's own times"
    extra = {"subject": subject} if subject else {}
    told_unit = {"unit": rows.unit or "mm (assumed)", "rate": f"{rate:.6g} Hz", "clock": clock}
    return MarkerData(
        name=Path(file).name,
        t=t,
        frame=rows.frame[order.rows],
        labels=labels,
        positions=positions,
        rate=rate,
        residual=None if rows.residual is None else rows.residual[order.rows] * scale,
        source=MappingProxyType({**source, **told_unit, **extra}),
        doubts=tuple(doubts),
    )


def _seen(positions: Array) -> NDArray[np.bool_]:
    return np.isfinite(positions[:, :, 0]).sum(axis=0) > 0


def _scale(rows: MarkerRows, file: str) -> tuple[float, list[Notice]]:
    """Metres in one unit."""
    if not rows.unit:
        return 1e-3, [notice("file.unit")]
    if rows.unit.casefold() not in _METRES:
        place, line = rows.unit_place
        message = f"Read the unit {shown(rows.unit)}. Expected mm, cm, m or in. Correct {place}."
        refuse(file, message, line)
    return _METRES[rows.unit.casefold()], []


def clean_labels(written: Sequence[str]) -> tuple[tuple[str, ...], str, list[Notice]]:
    """Names that are each there once, the subject that they share, and what was changed.

    `Subject:Marker` becomes `Marker` if all that have a subject have the same one.
    """
    doubts: list[Notice] = []
    subjects = {one.split(":", 1)[0] for one in written if ":" in one}
    subject = subjects.pop() if len(subjects) == 1 else ""
    bare = [one.removeprefix(f"{subject}:") if subject else one for one in written]
    if len(set(bare)) < len(bare) == len(set(written)):
        bare, subject = list(written), ""
    labels: list[str] = []
    for number, one in enumerate(bare, 1):
        label = re.sub(r"\s+", " ", one).strip() or f"unnamed {number}"
        if label in labels:
            again = next(
                n for n in range(2, len(bare) + 2) if f"{label} ({n})" not in bare + labels
            )
            doubts.append(notice("marker.twice", label=shown(label), name=f"{label} ({again})"))
            label = f"{label} ({again})"
        labels.append(label)
    return tuple(labels), subject, doubts
