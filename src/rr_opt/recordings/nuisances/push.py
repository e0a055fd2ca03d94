"""A push: for a moment the robot moves as its wheels cannot roll, or surges and slows again."""

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.gaps import bridged
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.warnings import Notice, notice

_WINDOW = 0.5
"""A push is over within this, s."""
_UNSEEN = 0.2
"""Gaps that are bridged, s."""
_FAR = (0.02, 0.06)
"""Least displacement by a push across the wheels, and along them, m. Wheels that slide cause 1 cm
of the first, and a tilted floor 4 cm of the second."""
_RARE = 10.0
"""Least ratio to the usual size over the recording."""
_MOST = 3
"""Most pushes of one recording that are reported."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """Pushes and surges."""
    width = max(1, round(_WINDOW / given.step))
    if not given.framed or len(given.t) < 4 * width:
        return
    # A push may coincide with a short gap.
    slip = given.slip_of([bridged(given.t, one, _UNSEEN) for one in given.motion])
    across = (slip.first, slip.second)
    looks = [("push.robot", _FAR[0], across)]
    if given.gait is not None:
        looks += [
            # Wheels that slide do so in every period, and hide a push in the usual size.
            ("push.robot", _FAR[0], tuple(_unusual(given, one) for one in across)),
            ("push.surge", _FAR[1], (_unusual(given, slip.along),)),
        ]
    for code, least, rows in looks:
        far = np.linalg.norm([_moved(one / given.stride, width) for one in rows], axis=0)
        pushes = _events(far, least, width)
        for at in pushes[:_MOST]:
            row = min(at + (width + given.stride) // 2, len(given.t) - 1)
            x, y = (float(one[np.isfinite(one)][_nearest(one, row)]) for one in given.motion[:2])
            yield notice(code, t=given.t[row], x=x, y=y, far=1e3 * far[at])
        if pushes:
            return


def _nearest(y: Array, row: int) -> int:
    return int(np.abs(np.flatnonzero(np.isfinite(y)) - row).argmin())


def _moved(each: Array, width: int) -> Array:
    """The sum over every window, without what is usual, m."""
    total = np.concatenate([[0.0], np.cumsum(np.nan_to_num(each))])
    sums = total[width:] - total[:-width]
    return sums - np.median(sums)


def _unusual(given: ExaminedRecording, moved: Array) -> Array:
    """Excess motion over the same phase of the periods before and after, m."""
    period = round(given.gait.period / given.step) if given.gait else 0
    if not 0 < 2 * period < len(moved):
        return np.zeros_like(moved)
    padded = np.concatenate([np.full(2 * period, np.nan), moved, np.full(2 * period, np.nan)])
    at = 2 * period + np.arange(len(moved))
    near = np.stack([padded[at + k * period] for k in (-2, -1, 1, 2)])
    order = np.sort(near, axis=0)  # NaN last
    count = np.isfinite(near).sum(axis=0)
    usual = np.where(count == 4, (order[1] + order[2]) / 2, np.where(count == 3, order[1], moved))
    return moved - usual


def _events(far: Array, least: float, width: int) -> list[int]:
    """The rows of the largest displacements, at least a window apart."""
    usual = 1.4826 * float(np.median(far))
    found: list[int] = []
    for at in np.argsort(-far, kind="stable")[: len(far) // 4].tolist():
        if far[at] < max(least, _RARE * usual):
            break
        if all(abs(at - other) > 2 * width for other in found):
            found.append(at)
    return sorted(found)
