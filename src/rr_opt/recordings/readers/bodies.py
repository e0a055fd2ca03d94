"""Poses of rigid bodies, as any format has them, to MarkerData.

A body that keeps its place on a platform says as much as three markers that do: its origin, and the
points 100 mm along those two of its own axes that are nearest to the floor. The markers' fit then
gives P and both angles: where P is on each body follows from a recording in which the joint moves,
or from a layout that names these points, `NAME`, `NAME x` and `NAME y`. Only the turn about the
axis that is up is taken of a body's rotation.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import METRES, MarkerData, marker_data

_ARM = 0.1
"""From a body's origin to its other points, and so about to the markers it was made of, m."""


def body_data(
    source: Mapping[str, str],
    *,
    names: Sequence[str],
    positions: Array,
    rotations: Array,
    unit: str,
    up: str = "z",
    **rows: Any,
) -> MarkerData:
    """Three points of each body; names (k,), positions (n, k, 3), in `unit`.

    rotations  (n, k, 3, 3), from the body's axes to the capture's; NaN where it was not seen
    rows       as of `marker_data`

    Raises InvalidFileError for fewer than two bodies.
    """
    if len(names) < 2:
        refuse(
            source["file"],
            f"Read the rigid body {shown(', '.join(names))}. Expected two, one on each platform. "
            "Export both.",
        )
    arm = _ARM / METRES.get(unit.casefold() or "mm", 1.0)
    labels, points = [], []
    for at, name in enumerate(names):
        origin, turned = positions[:, at], rotations[:, at]
        labels.append(name)
        points.append(np.where(np.isfinite(turned[:, 0, :1]), origin, np.nan))
        for axis, direction in _directions(turned, "xyz".index(up)):
            labels.append(f"{name} {'xyz'[axis]}")
            points.append(origin + arm * direction)
    return marker_data(
        source, labels=labels, positions=np.stack(points, 1), unit=unit, up=up, lever=_ARM, **rows
    )


def _directions(turned: Array, up: int) -> list[tuple[int, Array]]:
    """The two axes nearest to the floor and where they point (n, 3), of rotations (n, 3, 3)."""
    known = np.flatnonzero(np.isfinite(turned).all(axis=(1, 2)))
    nothing = np.full((len(turned), 3), np.nan)
    if not len(known):
        return [(0, nothing), (1, nothing)]
    first = turned[known[0]]
    across, ahead = (up + 1) % 3, (up + 2) % 3
    # What is left of a rotation, once the first is undone, is a turn about `up` and some tilt.
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
