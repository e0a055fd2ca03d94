"""Rows of marker positions, or of poses of rigid bodies, as any format has them, to MarkerData.

A body that keeps its place on a platform says as much as three markers that do: its origin, and the
points 100 mm along those two of its own axes that are nearest to the floor. The markers' fit then
gives P and both angles: where P is on each body follows from a recording in which the joint moves,
or from a layout that names these points, `NAME`, `NAME x` and `NAME y`. Only the turn about the
axis that is up is taken of a body's rotation.
"""

import math
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
from rr_opt.recordings.readers.text import NumberTable
from rr_opt.recordings.time_axis import check_rate, in_order, rate_of, time_notices
from rr_opt.recordings.warnings import Notice, notice


@dataclass(frozen=True)
class MarkerData:
    """Where k markers were seen at n times, in the capture system's frame.

    name       of the file
    t          (n,), s, increasing, on the capture's clock; 0 is where the file's own clock has it
    frame      (n,), the frames' numbers as in the file
    labels     (k,), the markers' names, each once
    positions  (n, k, 3), m; NaN where a marker was not seen
    rate       frames per second, Hz, as the file states it; else as the times have it
    residual   (n, k), m, of the capture's own triangulation, NaN where unknown; None: not stated
    up         the axis that points up where nobody says otherwise
    lever      of points of bodies whose poses were given: the noise of a place over that of an
               angle, m; None of markers
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
    up: str = "z"
    lever: float | None = None

    def __len__(self) -> int:
        return len(self.t)


METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "dm": 0.1, "in": 0.0254, "inches": 0.0254}
METRES |= {"millimeters": 1e-3, "millimetres": 1e-3, "centimeters": 1e-2}
METRES |= {"meters": 1.0, "metres": 1.0}


def rate_in(cell: str, said: str, file: str, line: int | None = None) -> float:
    """The rate that a cell of a header states, Hz; said: which cell, for the message.

    Raises InvalidFileError for what is no rate.
    """
    try:
        rate = float(cell.replace(",", "."))
    except ValueError:
        rate = math.nan
    if not 0 < rate < math.inf:
        refuse(file, f"Read {shown(cell)} {said}. Expected the rate in Hz. Correct it.", line)
    return rate


def frames_of(table: NumberTable, column: int, file: str, header: int) -> NDArray[np.int64]:
    """The frames' numbers (n,), in a column of a table whose header ends in a line.

    Raises InvalidFileError for a table without rows, and for what is no number of a frame.
    """
    if not len(table.values):
        refuse(file, "The file has no rows. Export the whole recording.", header)
    frames = table.values[:, column]
    wrong = np.flatnonzero(~(np.abs(frames) < 2**53) | (frames != np.round(frames)))
    if len(wrong):
        read = "nothing" if np.isnan(frames[wrong[0]]) else f"{frames[wrong[0]]:g}"
        message = f"Read {read} as a frame number. Expected a whole number. Correct it."
        refuse(file, message, int(table.lines[wrong[0]]))
    return frames.astype(np.int64)


def count_notice(stated: str, frames: NDArray[np.int64]) -> list[Notice]:
    """A notice if a header states another number of frames."""
    if not stated.isdecimal() or int(stated) == len(frames):
        return []
    return [notice("file.frames", stated=int(stated), count=len(frames))]


def marker_data(
    source: Mapping[str, str],
    *,
    frame: NDArray[np.int64],
    lines: NDArray[np.int64],
    t: Array | None,
    rate: float,
    labels: Sequence[str],
    positions: Array,
    unit: str,
    unit_place: tuple[str, int | None],
    rotations: Array | None = None,
    residual: Array | None = None,
    up: str = "z",
    doubts: Sequence[Notice] = (),
) -> MarkerData:
    """The markers, or three points of each body, in order of time, in metres, under clean names.

    frame      (n,), lines (n,) numbers of the rows in the file (of frames, if it has no lines)
    t          (n,), s, on the file's clock; None: frame 1 is at 0, and frames come at the rate
    rate       as stated by a header, Hz
    labels     (k,), as written
    positions  (n, k, 3), in `unit`
    unit_place what states the unit, and in which line
    rotations  (n, k, 3, 3), of bodies, from their axes to the capture's; NaN where not seen
    up         as of MarkerData

    Exact zeros are missing markers. Of frames that appear twice with different values no position
    is kept. Raises InvalidFileError if the unit is not one of length, the rate not one of a
    recording, or there are fewer than two bodies.
    """
    file = source["file"]
    if rotations is not None:
        if len(labels) < 2:
            refuse(
                file,
                f"Read the rigid body {shown(', '.join(labels))}. Expected two, one on each "
                "platform. Export both.",
            )
        arm = _ARM / METRES.get(unit.casefold() or "mm", 1.0)
        labels, positions = _points(labels, positions, rotations, arm, up)
    check_rate(rate, file)
    clean, subject, renamed = clean_labels(labels)
    doubts = [*doubts, *renamed]
    if not unit:
        doubts.append(notice("file.unit"))
    elif unit.casefold() not in METRES:
        place, line = unit_place
        message = f"Read the unit {shown(unit)}. Expected mm, cm, m or in. Correct {place}."
        refuse(file, message, line)
    scale = METRES[unit.casefold() or "mm"]
    times = (frame - 1) / rate if t is None else t
    order = in_order(times, positions, lines)
    if not len(order.rows):
        first = int(lines[0]) if len(lines) else None
        refuse(file, "Read no row with a time. Expected one in each. Export it again.", first)
    times, frame = times[order.rows], frame[order.rows]
    positions = positions[order.rows] * scale
    origin = (positions == 0).all(axis=2)
    if origin.any():
        doubts.append(notice("marker.origin", count=origin.sum()))
    positions[origin] = np.nan
    positions[order.unsure] = np.nan
    # A position is there as a whole, or not at all.
    positions[np.isnan(positions).any(axis=2)] = np.nan
    seen = [bool(one.any()) for one in np.isfinite(positions[:, :, 0]).T]
    if not all(seen):
        never = [one for one, known in zip(clean, seen, strict=True) if not known]
        doubts.append(notice("marker.never", names=", ".join(carriers(never))))
    doubts += order.doubts
    if len(times) > 1:
        measured = rate_of(times, file)
        doubts += time_notices(times, measured, None if t is None else rate)
        rate = rate if t is None else measured
    if frame[0] != 1 and t is None:
        doubts.append(notice("time.first", frame=frame[0], start=times[0]))
    clock = "t = 0 at frame 1" if t is None else "the file's own times"
    found = {"unit": unit or "mm (assumed)", "rate": f"{rate:.6g} Hz", "clock": clock}
    found |= {"subject": subject} if subject else {}
    return MarkerData(
        name=Path(file).name,
        t=times,
        frame=frame,
        labels=clean,
        positions=positions,
        rate=rate,
        residual=None if residual is None else residual[order.rows] * scale,
        up=up,
        lever=None if rotations is None else _ARM,
        source=MappingProxyType({**source, **found}),
        doubts=tuple(doubts),
    )


def carriers(labels: Sequence[str]) -> list[str]:
    """The names of markers, and those of rigid bodies without `NAME x` and the like."""
    points = {f"{one} {axis}" for one in labels for axis in "xyz"}
    return [one for one in labels if one not in points]


def clean_labels(written: Sequence[str]) -> tuple[tuple[str, ...], str, list[Notice]]:
    """Unique names, the subject that they share, and what was changed.

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


_ARM = 0.1
"""From a body's origin to its other points, and so about to the markers it was made of, m."""


def _points(
    names: Sequence[str], positions: Array, rotations: Array, arm: float, up: str
) -> tuple[list[str], Array]:
    """Names and positions (n, 3 k, 3) of each body's origin and of two points at a distance."""
    labels, points = [], []
    for at, name in enumerate(names):
        origin, turned = positions[:, at], rotations[:, at]
        labels.append(name)
        points.append(np.where(np.isfinite(turned[:, 0, :1]), origin, np.nan))
        for axis, direction in _directions(turned, "xyz".index(up)):
            labels.append(f"{name} {'xyz'[axis]}")
            points.append(origin + arm * direction)
    return labels, np.stack(points, 1)


def _directions(turned: Array, up: int) -> list[tuple[int, Array]]:
    """The two axes nearest to the floor and where they point (n, 3), of rotations (n, 3, 3)."""
    known = np.flatnonzero(np.isfinite(turned).all(axis=(1, 2)))
    nothing = np.full((len(turned), 3), np.nan)
    if not len(known):
        return [(0, nothing), (1, nothing)]
    first = turned[known[0]]
    across, ahead = (up + 1) % 3, (up + 2) % 3
    # A rotation relative to the first one is a turn about `up` and some tilt.
    since = turned @ first.T
    angle = np.arctan2(
        since[:, ahead, across] - since[:, across, ahead],
        since[:, across, across] + since[:, ahead, ahead],
    )
    found = []
    for axis in sorted(np.argsort(np.abs(first[up]), kind="stable")[:2].tolist()):
        size = np.hypot(first[across, axis], first[ahead, axis])
        begin = np.arctan2(first[ahead, axis] / size, first[across, axis] / size)
        direction = np.zeros((len(turned), 3))
        direction[:, across], direction[:, ahead] = np.cos(begin + angle), np.sin(begin + angle)
        found.append((axis, direction))
    return found


def matrices(rotations: Array, kind: str) -> NDArray[np.float64]:
    """Rotations (n, k, 3, 3) of quaternions x, y, z, w (n, k, 4), or else (n, k, 3).

    kind: `vector`, rad; or the order of Euler angles, rad, such as `XYZ` about the body's own axes.
    NaN and quaternions of no length stay NaN.
    """
    from scipy.spatial.transform import Rotation

    flat = rotations.reshape(-1, rotations.shape[-1])
    known = np.isfinite(flat).all(axis=1) & (np.abs(flat).max(axis=1, initial=0.0) < 1e6)
    known &= (np.linalg.norm(flat, axis=1) > 1e-6) | (flat.shape[1] == 3)
    made = np.full((len(flat), 3, 3), np.nan)
    if known.any():
        if flat.shape[1] == 4:
            found = Rotation.from_quat(flat[known])
        elif kind == "vector":
            found = Rotation.from_rotvec(flat[known])
        else:
            found = Rotation.from_euler(kind, flat[known])
        made[known] = found.as_matrix()
    return made.reshape(*rotations.shape[:2], 3, 3)
