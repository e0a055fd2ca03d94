"""Where a channel jumps: the level before and the level after do not meet.

A parabola through the seven samples before and one through the seven after are compared half way
between the two. At a kink they meet, at a jump they do not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

Array = NDArray[np.float64]

_SIDE = 7
_SURE = 8.0
"""Standard deviations; a kink between two samples can make a few."""
_KINK = 1.0
"""Steps of time from half way at which a kink may be."""
_APART = 15


@dataclass(frozen=True)
class Jump:
    """A jump between rows `row` and `row + 1`, by `size` in the channel's unit."""

    row: int
    size: float


def jumps(y: Array, sigma: float) -> tuple[Jump, ...]:
    """The jumps of y (n,), samples at equal steps, NaN where there is none.

    sigma: standard deviation of its noise. A jump next to a missing sample is not seen.
    """
    n = len(y)
    if n < 2 * _SIDE or not sigma > 0:
        return ()
    since = -(np.arange(_SIDE) + 0.5)
    V = np.vander(since, 3, increasing=True)
    level, slope, _ = np.linalg.pinv(V)
    count = n - 2 * _SIDE + 1
    size, bend = np.zeros(count), np.zeros(count)
    for i in range(_SIDE):
        before, after = _SIDE - 1 - i, _SIDE + i
        size += level[i] * (y[after : after + count] - y[before : before + count])
        # The sides are mirrored, so their slopes have opposite signs.
        bend += slope[i] * (y[after : after + count] + y[before : before + count])
    # A kink that is not half way leaves the levels apart by a part of its change of slope.
    beyond = np.maximum(np.abs(size) - _KINK * np.abs(bend), 0.0)
    off = np.nan_to_num(beyond / (sigma * np.sqrt(2 * (level**2).sum())))
    peak = (off > _SURE) & (off >= maximum_filter1d(off, _APART))
    return tuple(Jump(int(i) + _SIDE - 1, float(size[i])) for i in np.flatnonzero(peak))
