"""The period with which an angle repeats itself."""

from __future__ import annotations

import numpy as np

from rr_opt.array import Array

_PADDED = 8
"""Times as many samples as there are, so that the peak lies near one of the rates."""
_LONGEST = 60.0
"""So many seconds show a period, s."""
_FINEST = 4096
"""Samples that are looked at."""


def dominant(t: Array, y: Array) -> tuple[float, float]:
    """The period of the sine that explains most of y (n,) at t (n,), s, and how much that is.

    NaN is no sample. The second is the part of y's variance; both are NaN where there are too few.
    """
    known = np.isfinite(y) & (t <= t[0] + _LONGEST)
    if known.sum() < 8:
        return np.nan, np.nan
    t, y = t[known], y[known]
    n = min(len(t), _FINEST)
    even = np.linspace(t[0], t[-1], n)
    z = np.interp(even, t, y)
    z = (z - z.mean()) * np.hanning(n)
    power = np.abs(np.fft.rfft(z, _PADDED * n)) ** 2
    # Less than one and a half turns in all is a trend, and no period.
    first = int(1.5 * _PADDED)
    if len(power) < first + 3 or not power[first:].max() > 0:
        return np.nan, np.nan
    at = first + int(np.argmax(power[first:-1]))
    low, peak, high = np.log(np.maximum(power[at - 1 : at + 2], 1e-300))
    bend = low - 2 * peak + high
    off = 0.5 * (low - high) / bend if bend < 0 else 0.0
    rate = (at + float(np.clip(off, -0.5, 0.5))) / (_PADDED * n * (even[1] - even[0]))
    return 1 / rate, explained(t, y, 1 / rate)


def explained(t: Array, y: Array, period: float) -> float:
    """Of y's variance, what a constant and a sine of a period explain."""
    turn = 2 * np.pi * (t - t[0]) / period
    A = np.column_stack([np.ones(len(t)), np.sin(turn), np.cos(turn)])
    left = y - A @ np.linalg.lstsq(A, y, rcond=None)[0]
    return 1 - float(left @ left) / max(len(y) * float(np.var(y)), 1e-300)
