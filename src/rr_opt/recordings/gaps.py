"""Where a recording has no data, and how a short gap is bridged to be drawn, never to be fitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.recording import Flag, Recording
from rr_opt.recordings.time_step import time_step

Array = NDArray[np.float64]

SHORT = 0.1
"""A gap of a drawing that is bridged, s."""
LACKING = 1.5
"""Steps longer than this, in usual steps, lack a row."""


@dataclass(frozen=True)
class Gap:
    """A stretch without data.

    channels  those that have none; empty where whole rows are missing from the file
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
    """First index and the one after the last of every run of True."""
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
