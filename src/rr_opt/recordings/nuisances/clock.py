"""The period of an angle; and a clock whose rate changes while the robot drives on as before."""

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.warnings import Notice, notice

_LENGTHS = (3.0, 2.0)
"""Of a window, in periods: the first resolves slow periods, the second has more windows."""
_LEAST = 0.1
"""By which part of itself a period changes, at least."""
_STEADY = 0.05
_FEWEST = 3
"""Windows to either side of the change."""
_GAP = 0.25
"""Of a period without data, at most, within a window: a line across it is no sine."""
_SINE = 0.75
"""Of phi's variance in a window that a sine explains, where the angle is that of a gait."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """A clock that changes its rate."""
    t, phi = given.t, given.motion[3]
    known = np.isfinite(phi)
    usual = given.gait.period if given.gait else dominant(t, phi)[0]
    for length in _LENGTHS if usual > 0 else ():
        starts = np.arange(t[0], t[-1] - length * usual, max(usual / 4, (t[-1] - t[0]) / 400))
        ends = starts + length * usual
        pieces = [known & (t >= a) & (t <= b) for a, b in zip(starts, ends, strict=True)]
        gaps = [np.diff(t[one], prepend=a, append=b).max()
                for one, a, b in zip(pieces, starts, ends, strict=True)]  # fmt: skip
        found = [
            dominant(t[one], phi[one]) if gap < _GAP * usual else (np.nan, 0.0)
            for one, gap in zip(pieces, gaps, strict=True)
        ]
        periods = np.array([period if share > _SINE else np.nan for period, share in found])
        if at := _change(np.log(periods)):
            before, after = (float(np.nanmedian(one)) for one in (periods[:at], periods[at:]))
            when = _moment(t, phi, before, after, starts[at - 1])
            yield notice("clock.change", t=when, before=before, after=after)
            return


def _change(size: Array) -> int:
    """Where values (n,) step from one steady level to another; 0 if they do not."""
    best, place = np.inf, 0
    for at in range(_FEWEST, len(size) - _FEWEST + 1):
        sides = size[:at], size[at:]
        if any(np.isfinite(one).sum() < _FEWEST for one in sides):
            continue
        levels = [float(np.nanmedian(one)) for one in sides]
        left = [
            float(np.nanmean(np.abs(one - level))) for one, level in zip(sides, levels, strict=True)
        ]
        off = left[0] * at + left[1] * (len(size) - at)
        if abs(levels[1] - levels[0]) > _LEAST and max(left) < _STEADY and off < best:
            best, place = off, at
    return place


def _moment(t: Array, phi: Array, before: float, after: float, first: float) -> float:
    """When, from about a time on, the period changes, s: two sines are then nearest to phi."""
    last = first + max(_LENGTHS) * before + 2 * after
    near = np.isfinite(phi) & (t > first - before) & (t < last)
    t, phi = t[near], phi[near]
    tries = np.linspace(t[0] + before / 2, t[-1] - after / 2, 100)
    left = [
        sum(
            (1 - explained(t[side], phi[side], period)) * float(np.var(phi[side])) * side.sum()
            for side, period in ((t <= one, before), (t > one, after))
        )
        for one in tries
    ]
    return float(tries[int(np.argmin(left))])


_PADDED = 8
"""Times as many samples as there are, so that the peak lies near one of the rates."""
_LONGEST = 60.0
"""Of a recording that are looked at for a period, s."""
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
