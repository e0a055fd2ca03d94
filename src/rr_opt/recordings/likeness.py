"""Offsets between two clocks at which two signals look alike, before any of them is fitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_STEP = 0.02
"""Step at which two recordings are compared all along, s."""
_OVERLAP = 0.2
"""The part of the shorter recording that has to overlap."""
_PEAK = 0.9
"""Peaks that are likely: so high relative to the best."""
_LONGEST = 20_000.0
"""Recordings of more than this are not compared, s."""


@dataclass(frozen=True)
class Peaks:
    """Offsets (m,), s, at which two signals are alike: how much (at most 1), and over how many s.

    A periodic motion has one a period.
    """

    offset: Array
    alike: Array
    overlap: Array

    def tried(self, near: tuple[float, ...], most: int) -> list[float]:
        """Those worth a fit: the likest, the longest, and the nearest to some offsets, s."""
        likest = np.argsort(-self.alike, kind="stable")[:most]
        longest = np.argsort(-self.alike * self.overlap, kind="stable")[:most]
        nearest = [int(np.abs(self.offset - one).argmin()) for one in near if len(self.offset)]
        return self.offset[sorted({*likest.tolist(), *longest.tolist(), *nearest})].tolist()


def peaks(t: Array, one: Array, s: Array, two: Array) -> Peaks:
    """Of offsets from t to s, where `one` is seen at t (n,) and `two` at s (m,); NaN is nothing."""
    # Here and not above: it takes half a second to load, and only servo logs need it.
    from scipy.signal import correlate  # noqa: PLC0415

    first, second = _resampled(t, one), _resampled(s, two)
    if first is None or second is None:
        return Peaks(np.empty(0), np.empty(0), np.empty(0))
    alike = correlate(second, first, method="fft")
    overlap = correlate(np.ones(len(second)), np.ones(len(first)), method="fft")
    size = np.sqrt(
        np.maximum(correlate(second**2, np.ones(len(first)), method="fft"), 0)
        * np.maximum(correlate(np.ones(len(second)), first**2, method="fft"), 0)
    )
    fits = overlap > _OVERLAP * min(len(first), len(second))
    score = np.where(fits, alike / np.maximum(size, 1e-12), -1.0)
    peak = np.r_[False, (score[1:-1] > score[:-2]) & (score[1:-1] >= score[2:]), False]
    rows = np.flatnonzero(peak & (score > _PEAK * score.max()) & (score > 0))
    lag = (rows - (len(first) - 1)) * _STEP
    return Peaks(s[0] - t[0] + lag, score[rows], overlap[rows] * _STEP)


def _resampled(t: Array, y: Array) -> Array | None:
    known = np.isfinite(y)
    if known.sum() < 2 or not 0 < t[-1] - t[0] < _LONGEST:
        return None
    z = np.interp(np.arange(t[0], t[-1], _STEP), t[known], y[known])
    z = z - z.mean()
    return z if np.abs(z).max() > 0 else None
