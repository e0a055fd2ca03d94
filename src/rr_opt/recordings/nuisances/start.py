"""A start from rest that is said of a robot that drives already."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.nuisances.evidence import CLEAN, Evidence
from rr_opt.recordings.warnings import Notice, notice

_PART = 0.25
"""Of a period whose length of way is compared."""
_SURE = 5.0
_MOST = 0.4
"""Of the way that its later speed would add, a start from rest lacks 0.65 and more, also where
friction is strong, and 0.44 where the centres of mass are 3 cm off the axes. A robot that has
driven for a few periods only lacks as much, and is not noticed."""
_FEWEST = 4


def _look(given: Evidence) -> Iterator[Notice]:
    if given.gait is None or given.start != "rest":
        return
    if given.t[0] >= given.gait.period / 4:
        yield notice("clock.start", first=given.t[0])
        return
    if given.slip.size > CLEAN:
        # Not the joint itself is seen, or the wheels slide: how far axle 1 rolls does not show.
        return
    ways, speeds = _periods(given, given.gait.period)
    if len(ways) < _FEWEST:
        return
    late = slice(len(ways) // 2, None)
    part = _PART * given.gait.period
    # From rest the speed lacks, all along, what the robot has later when a period begins.
    lacking = float(np.median(speeds[late])) * part
    first = float(ways[0] - np.median(ways[late]))
    spread = 1.4826 * float(np.median(np.abs(ways[late] - np.median(ways[late]))))
    if not abs(lacking) > _SURE * max(np.sqrt(2) * given.sigma[0], spread):
        return
    if -first / lacking < _MOST:
        yield notice("start.running", later=1e3 * lacking / part)


def _periods(given: Evidence, period: float) -> tuple[Array, Array]:
    """How far axle 1 rolls in the first part of each period from t = 0, m, and its speed there.

    The first is of all periods but those with gaps, the other m/s at their beginning.
    """
    along = given.slip.along / given.stride
    whole = np.concatenate([[0.0], np.cumsum(np.nan_to_num(along))])
    known = np.concatenate([[0], np.cumsum(np.isfinite(along))])
    t = given.t[: len(whole)] + given.step * (given.stride - 1) / 2
    part = max(1, round(_PART * period / given.step))
    ways, speeds = [], []
    for n in range(int((t[-1] - t[0]) / period)):
        at = int(np.searchsorted(t, n * period))
        if at + part >= len(whole) or known[at + part] - known[at] < 0.8 * part:
            if n == 0:
                break
            continue
        ways.append(whole[at + part] - whole[at])
        before = max(at - part // 2, 0)
        after = at + part // 2
        speeds.append((whole[after] - whole[before]) / ((after - before) * given.step))
    return np.array(ways), np.array(speeds)


LOOK = _look
