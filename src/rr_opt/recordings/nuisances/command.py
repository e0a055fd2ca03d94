"""An angle that contradicts its command: another gait, unit or sign, or an offset of the clock.

Or a clock that changes its rate while the robot drives on as before.
"""

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.clock_fit import RUNS_OFF, ClockFit
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.warnings import Notice, notice

_LENGTHS = (3.0, 2.0)
"""Of a window, in periods: the first resolves slow periods, the second has more windows."""
_LEAST = 0.1
"""Least relative change of a period."""
_STEADY = 0.05
_FEWEST = 3
"""Windows to either side of the change."""
_GAP = 0.25
"""Longest gap in a window, in periods: a line across it is no sine."""
_SINE = 0.75
"""Share of phi's variance in a window that a sine explains if the robot drives a gait."""


def look_at_clock(given: ExaminedRecording) -> Iterator[Notice]:
    """A clock that changes its rate."""
    t, phi = given.t, given.motion[3]
    known = np.isfinite(phi)
    usual = given.gait.period if given.gait else dominant(t, phi)[0]
    seen, angle = t[known], phi[known]
    edges = np.concatenate([t[:1], seen, t[-1:]])
    gaps = np.flatnonzero(np.diff(edges) >= _GAP * usual)
    for length in _LENGTHS if usual > 0 else ():
        starts = np.arange(t[0], t[-1] - length * usual, max(usual / 4, (t[-1] - t[0]) / 400))
        ends = starts + length * usual
        unseen = np.minimum.outer(ends, edges[gaps + 1]) - np.maximum.outer(starts, edges[gaps])
        first, last = np.searchsorted(seen, starts), np.searchsorted(seen, ends, "right")
        pieces = {
            row: (seen[first[row] : last[row]], angle[first[row] : last[row]])
            for row in np.flatnonzero((unseen < _GAP * usual).all(axis=1))
        }
        periods = np.full(len(starts), np.nan)
        for row, piece in pieces.items():
            periods[row] = period_of(*piece)
        if not np.nanmax(periods, initial=0) > (1 + _LEAST) * np.nanmin(periods, initial=np.inf):
            continue
        for row, piece in pieces.items():
            if not dominant(*piece)[1] > _SINE:
                periods[row] = np.nan
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
    """The time, s, near `first` at which the period changes: where two sines fit phi best."""
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
"""Factor of zero-padding, so that the peak is near one of the frequencies."""
_LONGEST = 60.0
"""Length of a recording that is searched for a period, s."""
_FINEST = 4096
"""Most samples that are used."""


def dominant(t: Array, y: Array) -> tuple[float, float]:
    """The period, s, of the sine that explains most of y (n,) at t (n,), s, and its share.

    NaN is no sample. The share is of y's variance; both are NaN where there are too few samples.
    """
    period = period_of(t, y)
    return period, explained(*_looked_at(t, y), period) if np.isfinite(period) else np.nan


def _looked_at(t: Array, y: Array) -> tuple[Array, Array]:
    known = np.isfinite(y) & (t <= t[0] + _LONGEST)
    return t[known], y[known]


def period_of(t: Array, y: Array) -> float:
    """The period of `dominant` alone."""
    t, y = _looked_at(t, y)
    n = min(len(t), _FINEST)
    if n < 8:
        return np.nan
    even = np.linspace(t[0], t[-1], n)
    z = np.interp(even, t, y)
    z = (z - z.mean()) * np.hanning(n)
    power = np.abs(np.fft.rfft(z, _PADDED * n)) ** 2
    # Less than one and a half turns in all is a trend, and no period.
    first = int(1.5 * _PADDED)
    if len(power) < first + 3 or not power[first:].max() > 0:
        return np.nan
    at = first + int(np.argmax(power[first:-1]))
    low, peak, high = np.log(np.maximum(power[at - 1 : at + 2], 1e-300))
    bend = low - 2 * peak + high
    off = 0.5 * (low - high) / bend if bend < 0 else 0.0
    rate = (at + min(max(off, -0.5), 0.5)) / (_PADDED * n * (even[1] - even[0]))
    return float(1 / rate)


def explained(t: Array, y: Array, period: float) -> float:
    """The share of y's variance that a constant and a sine of a period explain."""
    turn = 2 * np.pi * (t - t[0]) / period
    A = np.column_stack([np.ones(len(t)), np.sin(turn), np.cos(turn)])
    left = y - A @ np.linalg.lstsq(A, y, rcond=None)[0]
    return 1 - float(left @ left) / max(len(y) * float(np.var(y)), 1e-300)


_ALIKE, _OTHER = 0.5, 0.8
"""Least shares of phi's variance that its own gait, or a sine of another period, explains."""
_SIZE = 20.0
"""Ratio of phi's swing to the command's, or inverse, that only another unit explains."""
_LATE = 1e-3
"""A smaller offset is negligible, s."""
_SURE = 3.0
_LESS = 0.01
_BIASED = 2e-3
_HALF = 0.05
"""Periods."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """An angle that does not follow its command, or not at once."""
    if given.gait is None:
        return
    fit, period = given.command, given.gait.period
    if fit is None:
        yield notice("command.still")
    elif fit.residual**2 > (1 - _ALIKE) * float(np.nanvar(given.motion[3])):
        seen, share = dominant(given.t, given.motion[3])
        if share > _OTHER and abs(seen / period - 1) > _HALF:
            yield notice("command.period", period=seen, commanded=period)
        else:
            yield notice("command.other", scale=fit.scale)
    elif not 1 / _SIZE < abs(fit.scale) < _SIZE:
        yield notice("units.phi", times=fit.scale)
    elif abs(abs(fit.offset) / period - 0.5) < _HALF:
        yield notice("command.half", late=abs(fit.offset), period=period)
    else:
        yield from _details(given, fit)


def _details(given: ExaminedRecording, fit: ClockFit) -> Iterator[Notice]:
    if abs(fit.offset) > max(_LATE, _SURE * fit.sigma[0]):
        low, high = sorted(1e3 * abs(end) for end in fit.interval(0))
        way, size = "lags" if fit.offset < 0 else "leads", 1e3 * abs(fit.offset)
        yield notice("clock.offset", way=way, size=size, low=low, high=high, why=_late(given, fit))
    if abs(fit.drift) > max(RUNS_OFF, _SURE * fit.sigma[1]):
        low, high = (1e6 * end for end in fit.interval(1))
        yield notice("clock.drift", drift=1e6 * fit.drift, low=low, high=high)
    if abs(fit.scale - 1) > max(_LESS, _SURE * fit.sigma[2]):
        half, why = 1.96 * fit.sigma[2], _scale(fit.scale)
        yield notice("command.scale", scale=fit.scale, half=half, why=why)
    if abs(fit.bias) > max(_BIASED, _SURE * fit.sigma[3]):
        yield notice("command.bias", bias=1e3 * fit.bias, degrees=np.degrees(fit.bias))


def _scale(scale: float) -> str:
    if scale < 1:
        return "a lag or backlash reduces it; a clock offset would not."
    return "play with inertia increases it; a clock offset would not."


def _late(given: ExaminedRecording, fit: ClockFit) -> str:
    if fit.offset > 0:
        return "a clock offset, as no servo moves before its command"
    if given.clock_known:
        return "servo delay, as its log gives the clock offset"
    both = "servo delay or a clock offset."
    if given.start == "rest":
        return (
            f"{both} The start from rest is part of the fit, but only a servo model can "
            "distinguish the two"
        )
    return f"{both} This recording cannot distinguish the two: their effect is the same"


def follows(given: ExaminedRecording, phi: Array) -> bool:
    """Whether an angle (n,) is within a quarter of a period of its command, if that shows."""
    if given.gait is None:
        return True
    known = np.isfinite(phi)
    command = given.gait.angle(given.t[known])
    alike = float(np.corrcoef(phi[known], command)[0, 1])
    return not alike < -_ALIKE
