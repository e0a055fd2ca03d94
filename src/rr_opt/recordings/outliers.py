"""Samples that the motion does not explain: found, and never those of a kink.

A sample is suspected if it is off the smooth curve through all others by more than Gaussian noise
is once in a million. The worst of its surroundings is taken out, the curve is drawn again, and so
on until none is left; then each that was taken out is tried again. What remains suspect is an
outlier if the samples before it and those after it, each on their own, do not foretell it either.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d
from scipy.special import ndtri

from rr_opt.recordings.noise import NoiseEstimate, noise_of
from rr_opt.recordings.one_sided import misses
from rr_opt.recordings.smooth import Smooth, smoothed
from rr_opt.recordings.strength import strength
from rr_opt.recordings.time_step import time_step

Array = NDArray[np.float64]

FALSE_ALARM = 1e-6
"""The share of good samples, with Gaussian noise, that the smooth curve suspects."""
_SUSPECT = float(-ndtri(FALSE_ALARM / 2))
_ONE_SIDE = 3.5
"""A parabola through one side misses a good sample by less; it has its own curvature to miss."""
_ROUNDS = 12
_NEAR = 40
"""Samples to either side that a round looks at again."""
_LEAST = 0.5
"""Of the stated noise; what is finer is not looked for."""


@dataclass(frozen=True)
class Outliers:
    """What a channel's samples are.

    outlier  (n,)
    noise    of the others
    sigma    standard deviation that a sample was allowed, the usual one
    ratio    the strength of the motion (`strength`)
    """

    outlier: NDArray[np.bool_]
    noise: NoiseEstimate
    sigma: float
    ratio: float


def outliers(t: Array, y: Array, sigma: Array) -> Outliers:
    """The outliers of y (n,) at t (n,), s; NaN is no sample. sigma: (n,), as stated."""
    suspect = np.zeros(len(y), bool)
    known = np.isfinite(y)
    noise, ratio = noise_of(y), 1.0
    if known.sum() < 4 or not np.nanmax(np.abs(y)) < 1e12:
        return Outliers(suspect, noise, float(np.median(sigma)), ratio)
    scale = 1.0
    usual = float(np.median(sigma))
    for _ in range(3):
        left = np.where(suspect, np.nan, y)
        noise = noise_of(left)
        least = max(_LEAST, 1e-6 * float(np.nanstd(y)) / usual)
        scale = max(noise.sigma / usual, least) if np.isfinite(noise.sigma) else 1.0
        ratio = strength(left, scale * usual)
        before, suspect = suspect, _suspects(t, y, scale * sigma, ratio)
        if (suspect == before).all():
            break
    return Outliers(_foretold(t, y, suspect, scale * sigma), noise, scale * usual, ratio)


def _suspects(t: Array, y: Array, sigma: Array, ratio: float) -> NDArray[np.bool_]:
    out = np.zeros(len(y), bool)
    look = np.ones(len(y), bool)
    for _ in range(_ROUNDS):
        rows = np.flatnonzero(look)
        off = np.zeros(len(y))
        off[rows] = _off(t[rows], y[rows], out[rows], sigma[rows], ratio)
        # Among neighbours that all are off, only the worst is known to be at fault.
        inside = np.where(out, 0.0, off)
        highest = np.asarray(maximum_filter1d(inside, 5), float)
        worst = (inside > _SUSPECT) & (inside >= highest)
        back = out & look & (off <= _SUSPECT)
        if not worst.any():
            return out & ~back
        out = (out & ~back) | worst
        changed = (inside > _SUSPECT) | worst | back
        look = np.asarray(maximum_filter1d(changed, 2 * _NEAR + 1), bool)
    return out


def _off(t: Array, y: Array, out: NDArray[np.bool_], sigma: Array, ratio: float) -> Array:
    """How far each sample is off the curve through the others, in standard deviations."""
    curve: Smooth = smoothed(t, np.where(out, np.nan, y), sigma, ratio)
    # A sample pulls the curve: what it is off the curve through the others is larger by its part.
    rest = np.maximum(1 - curve.leverage, 1e-6)
    scale = np.where(out, np.hypot(sigma, curve.value_sigma), sigma * np.sqrt(rest))
    return np.nan_to_num(np.abs(y - curve.value) / scale, nan=0.0)


def _foretold(t: Array, y: Array, suspect: NDArray[np.bool_], sigma: Array) -> NDArray[np.bool_]:
    rows = np.flatnonzero(suspect)
    if not len(rows):
        return suspect
    before, after = misses((t - t[0]) / time_step(t), y, np.isfinite(y) & ~suspect, rows, sigma)
    kept = np.minimum(before, after) > _ONE_SIDE
    # With nothing on either side nothing is known.
    kept &= np.isfinite(before) | np.isfinite(after)
    outlier = suspect.copy()
    outlier[rows[~kept]] = False
    return outlier
