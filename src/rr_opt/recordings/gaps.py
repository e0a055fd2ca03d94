"""Where a recording has no data, stands still or jumps.

A jump is where the level before and the level after do not meet: a parabola through a few samples
before and one through a few after are compared half way between the two. At a kink they meet, at a
jump they do not.
"""

from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from rr_opt.array import Array
from rr_opt.formatting import counted
from rr_opt.model.experiment import CHANNELS, Flag, Recording
from rr_opt.recordings.time_axis import LACKING, time_step
from rr_opt.recordings.warnings import Notice, notice

SHORT = 0.1
"""Longest gap that is bridged in drawings, s."""


@dataclass(frozen=True)
class Gap:
    """A stretch without data.

    channels  those without data; empty where whole rows are missing from the file
    start     the last time with data before it (or the first of the recording), s
    end       the first time with data after it (or the last of the recording), s
    samples   how many are missing
    """

    channels: tuple[str, ...]
    start: float
    end: float
    samples: int

    @property
    def length(self) -> float:
        """s."""
        return self.end - self.start


def gaps(recording: Recording) -> tuple[Gap, ...]:
    """All gaps in the order of their start; channels with the same gap share it."""
    t = recording.t
    shared: dict[tuple[int, int], list[str]] = {}
    for channel in recording.channels:
        missing = (recording.flags[channel] & Flag.MISSING) > 0
        for run in runs(missing):
            shared.setdefault(run, []).append(channel)
    found = [
        Gap(tuple(names), float(t[max(a - 1, 0)]), float(t[min(b, len(t) - 1)]), b - a)
        for (a, b), names in shared.items()
    ]
    step = time_step(t)
    found += [
        Gap((), float(t[i]), float(t[i + 1]), round((t[i + 1] - t[i]) / step) - 1)
        for i in np.flatnonzero(np.diff(t) > LACKING * step)
    ]
    return tuple(sorted(found, key=lambda gap: (gap.start, gap.channels)))


def runs(member: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """The first index, and the one after the last, of every run of True."""
    edges = np.diff(np.concatenate([[0], member.astype(np.int8), [0]]))
    starts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return [(int(a), int(b)) for a, b in zip(starts, ends, strict=True)]


def bridged(t: Array, y: Array, longest: float = SHORT) -> Array:
    """y (n,) with its short gaps bridged by straight lines, to be drawn. Longer ones stay NaN."""
    known = np.isfinite(y)
    if known.all() or not known.any():
        return y
    whole = np.interp(t, t[known], y[known])
    bridge = y.copy()
    for a, b in runs(~known):
        if a > 0 and b < len(t) and t[b] - t[a - 1] <= longest:
            bridge[a:b] = whole[a:b]
    return bridge


_COPIES = 3
"""Copies in a row, in every channel, that noise does not produce."""
_ORDER = 4
"""Order of the differences, which vanish for an interpolated curve but not for noise."""
_VANISHING = 0.02
"""Share of the usual differences: less in every channel, over several rows, is no chance."""
_ROWS = 8
_COMMON = 0.2
"""A recording with a larger share of such rows has no noise: it is computed."""


def without_inventions(recording: Recording) -> tuple[Recording, tuple[Notice, ...]]:
    """The recording with samples that were not measured flagged OUTLIER, and what was found.

    A capture system that hangs repeats its last values; others fill gaps with a smooth curve.
    Neither has noise.
    """
    steps = np.stack([np.diff(recording.data(channel)) for channel in CHANNELS])
    copied = np.append(False, (steps == 0).all(axis=0))
    found = []
    for kind, member in (
        ("held.rows", _long(copied, _COPIES)),
        ("filled.rows", _long(_smooth(steps), _ROWS) & ~copied),
    ):
        stretches = runs(member)
        if not stretches or member.mean() > _COMMON:
            continue
        flag = member * np.uint8(Flag.OUTLIER)
        flags = {channel: own | flag for channel, own in recording.flags.items()}
        recording = replace(recording, flags=MappingProxyType(flags))
        first, last = max(stretches, key=lambda one: one[1] - one[0])
        start, end = recording.t[max(first - 1, 0)], recording.t[last - 1]
        times, count = counted(len(stretches), "time"), int(member.sum())
        found.append(notice(kind, count=count, times=times, longest=end - start, start=start))
    return recording, tuple(found)


def _smooth(steps: Array) -> NDArray[np.bool_]:
    """Whether a row (n,) is among some whose differences vanish; steps (channels, n - 1)."""
    size = np.abs(np.diff(steps, _ORDER - 1, axis=1))
    known = np.isfinite(size).any(axis=1)
    if not known.any() or not size.shape[1]:
        return np.zeros(steps.shape[1] + 1, bool)
    usual = np.nanmedian(size[known], axis=1, keepdims=True)
    vanishing = (size[known] <= _VANISHING * usual).all(axis=0)
    return np.convolve(vanishing, np.ones(_ORDER + 1)) > 0


def _long(member: NDArray[np.bool_], fewest: int) -> NDArray[np.bool_]:
    """The same without stretches shorter than `fewest`."""
    kept = np.zeros_like(member)
    for first, last in runs(member):
        kept[first:last] = last - first >= fewest
    return kept


_SIDES = (7, 5, 3)
"""Samples to either side: few where there is little noise."""
_SURE = 8.0
"""Standard deviations; a kink between two samples can cause a few."""
_KINK = 1.0
"""Farthest distance of a kink from half way, in steps of time."""
_APART = 15


@dataclass(frozen=True)
class Jump:
    """A jump between rows `row` and `row + 1`, by `size` in the channel's unit."""

    row: int
    size: float


def _between(y: Array, side: int) -> tuple[Array, Array, float]:
    """Differences half way between samples of the parabolas through `side` samples to either side.

    The sizes of the jumps (m,), the changes of slope (m,), per step of time; and the standard
    deviation of a size, in units of that of a sample.
    """
    since = -(np.arange(side) + 0.5)
    level, slope, _ = np.linalg.pinv(np.vander(since, 3, increasing=True))
    before, after = (sliding_window_view(y, side)[k : len(y) - 2 * side + 1 + k] for k in (0, side))
    # The sides are mirrored, so their slopes have opposite signs.
    size = after @ level - before @ level[::-1]
    bend = after @ slope + before @ slope[::-1]
    return size, bend, float(np.sqrt(2 * (level**2).sum()))


def _bulk(size: Array) -> float:
    """Standard deviation of the bulk of sizes."""
    known = size[np.isfinite(size)]
    return float(np.median(np.abs(known))) / 0.6745 if known.size else 0.0


def jumps(y: Array, sigma: float) -> tuple[Jump, ...]:
    """The jumps of y (n,), samples at equal steps, NaN where there is none.

    sigma: standard deviation of its noise. A jump next to a missing sample is not seen.
    """
    if len(y) < 2 * _SIDES[0] or not sigma > 0:
        return ()
    # With little noise, the curvature that parabolas miss counts more: less for shorter ones.
    found = [_between(y, side) for side in _SIDES]
    scales = [max(sigma * noise, _bulk(size)) for size, _, noise in found]
    k = int(np.argmin(scales))
    size, bend, _ = found[k]
    # A kink that is not half way separates the levels by a fraction of its change of slope.
    beyond = np.maximum(np.abs(size) - _KINK * np.abs(bend), 0.0)
    off = np.nan_to_num(beyond / scales[k])
    peak = (off > _SURE) & (off >= maximum_filter1d(off, _APART))
    return tuple(Jump(int(i) + _SIDES[k] - 1, float(size[i])) for i in np.flatnonzero(peak))
