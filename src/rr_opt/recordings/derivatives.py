"""Derivatives of a recorded channel, with their uncertainty; for a diagnosis to look at.

The channel is a signal whose third derivative is white noise, plus the sensor's white noise. The
strength of the first is the likeliest for the data, that of the second is estimated from the data
or given; there is no window to choose. What comes out are means and standard deviations of the
signal and its derivatives, given all samples. They are those of this prior: where the motion has a
kink, as at a start from rest, the true derivative jumps and the error is larger than its sigma.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.noise import noise_of
from rr_opt.recordings.smooth import Smooth, smoothed
from rr_opt.recordings.strength import strength

Array = NDArray[np.float64]


def derivatives(t: Array, y: Array, sigma: Array | float | None = None) -> Smooth:
    """The signal behind y (n,) and its first two derivatives at t (n,), s.

    y: NaN where there is no sample. sigma: standard deviation of the samples, (n,) or one; None
    has it estimated.
    """
    if sigma is None:
        sigma = noise_of(y).sigma
    usual = float(np.median(sigma))
    if not usual > 0:
        # No noise that could be seen: the samples count as they are.
        size = float(np.nanstd(y)) if np.isfinite(y).any() else 0.0
        usual = max(1e-9 * size, 1e-300)
        sigma = usual
    return smoothed(t, y, sigma, strength(y, usual))
