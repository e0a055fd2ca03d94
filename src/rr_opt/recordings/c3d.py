"""C3D, the binary format of motion capture (c3d.org).

A header of 512 bytes, the parameters, then frame after frame the points and the analog samples. It
is read here, and not by a library: the usual one ends the program on damaged files, and reads no
more than 65535 frames, 11 minutes at 100 Hz.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rr_opt.recordings.c3d_frames import BLOCK, frame_count, points_of, read_header
from rr_opt.recordings.c3d_parameters import Values, read_parameters
from rr_opt.recordings.marker_rows import MarkerRows, marker_data
from rr_opt.recordings.markers_file import MarkerData
from rr_opt.recordings.refusal import refuse

_KEY = 0x50
"""The second byte of every C3D file."""
_NOT_MARKERS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS")
"""Parameters of the group POINT that list points which are no places."""


def is_c3d(content: bytes) -> bool:
    """Whether the first bytes are those of a C3D file."""
    return len(content) > 1 and content[1] == _KEY and 0 < content[0] < 128


def markers_from_c3d(content: bytes, file: str, name: str) -> MarkerData:
    """The markers of a C3D file, whose bytes are `content`.

    A residual below 0 is a marker that was not seen. Raises InvalidFileError.
    """
    try:
        header = read_header(content)
        parameters = read_parameters(content, BLOCK * (content[0] - 1), header.processor)
    except ValueError as error:
        refuse(file, f"The C3D file is damaged or not whole: {error}. Export it once more.")
    count, doubts = frame_count(content, header, parameters, file)
    labels = _labels(parameters, header.points)
    others = {one for key in _NOT_MARKERS for one in parameters.get(f"POINT:{key}", ())}
    kept = [at for at, label in enumerate(labels) if label not in others]
    if len(kept) < len(labels):
        doubts.append(f"{len(labels) - len(kept)} points are no places, and were not read.")
    if not kept:
        refuse(file, "The C3D file has no markers. Expected at least one. Export the trajectories.")
    positions, residual = points_of(content, header, count, kept)
    endless = np.isinf(positions).any(axis=2)
    if endless.any():
        doubts.append(f"{endless.sum()} positions are infinite, and were taken as missing.")
    positions[endless | ~(residual >= 0)] = np.nan
    residual[~(residual >= 0)] = np.nan
    made_up = residual == 0
    if made_up.any() and (residual > 0).any():
        doubts.append(
            f"{made_up.sum()} positions have the residual 0: the capture's software made them up, "
            "and nobody measured them."
        )
    rate = _number(parameters, "POINT:RATE", header.rate)
    frame = header.first + np.arange(count, dtype=np.int64)
    unit = parameters.get("POINT:UNITS", ())
    rows = MarkerRows(
        frame=frame,
        t=None,
        rate=rate,
        labels=tuple(labels[at] for at in kept),
        positions=positions,
        unit=str(unit[0]) if unit else "",
        unit_place=("the parameter POINT:UNITS", None),
        lines=frame,
        residual=residual,
    )
    return marker_data(rows, name, {"file": file, "format": "C3D"}, doubts)


def _labels(parameters: Mapping[str, Values], count: int) -> list[str]:
    """The names of all points: LABELS holds 255 at most, LABELS2 the next ones."""
    keys = ["POINT:LABELS", *(f"POINT:LABELS{n}" for n in range(2, 300))]
    labels = [str(one) for key in keys for one in parameters.get(key, ())]
    return (labels + [""] * count)[:count]


def _number(parameters: Mapping[str, Values], name: str, default: float) -> float:
    values = parameters.get(name, ())
    return float(values[0]) if values and isinstance(values[0], float) else default
