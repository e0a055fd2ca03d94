"""How far samples may be off the motion where nobody stated the noise, or its steps are coarse."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.noise import noise_of, spread_at

Array = NDArray[np.float64]

_CHANCE, _COLOURED = 1e-4, 1.2
_STRIDES = (2, 4, 8)
_LEVELS = 4
"""A channel with fewer levels than this part of its samples comes in steps."""


def usual_noise(y: Array) -> Array:
    """The noise of a channel of which none is stated, (n,); never zero.

    Behind a filter the quickest differences tell too little. The largest over slower ones is then
    taken; if it holds some of the motion, fewer outliers are found, and no good sample is flagged.
    """
    noise = noise_of(y)
    sigma = noise.sigma
    if noise.p_white < _CHANCE and noise.colour > _COLOURED:
        sigma = max(sigma, *np.nan_to_num([spread_at(y, stride) for stride in _STRIDES]))
    size = float(np.nanmax(np.abs(y))) if np.isfinite(y).any() else 1.0
    least = max(1e-9 * size, 1e-12)
    return np.full(len(y), max(sigma, least) if math.isfinite(sigma) else max(size, least))


def step_of(y: Array) -> float:
    """The step in which the values y (n,) come, in their unit; 0 if they are not rounded."""
    known = y[np.isfinite(y)]
    levels = np.unique(np.round(known, 12))
    if len(levels) < 3 or len(levels) * _LEVELS > len(known):
        return 0.0
    apart = np.diff(levels)
    step = float(np.median(apart))
    off = np.abs(apart / step - np.round(apart / step))
    return step if off.max() < 1e-3 else 0.0
