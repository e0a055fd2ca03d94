"""How well markers keep to rigid platforms: their noise, and the frames that do not keep to it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri

from rr_opt.recordings.rigid import Fit

Array = NDArray[np.float64]

FALSE_ALARM = 1e-6
"""The share of good frames, with Gaussian noise, whose squares are larger than they may be."""


def marker_noise(fit: Fit) -> float:
    """The standard deviation of one coordinate of one marker, m; NaN if no frame can tell.

    The median over frames, so that up to half of them may hold anything.
    """
    told = fit.freedom > 0
    if not told.any():
        return float("nan")
    freedom = fit.freedom[told]
    # The median of chi squared, by Wilson and Hilferty's cube.
    median = freedom * (1 - 2 / (9 * freedom)) ** 3
    return float(np.sqrt(np.median(fit.squares[told] / median)))


def beyond(fit: Fit, sigma: float) -> NDArray[np.bool_]:
    """The frames (n,) whose markers do not fit two rigid platforms with noise sigma, m."""
    most = sigma**2 * chdtri(np.maximum(fit.freedom, 1), FALSE_ALARM)
    # Noise-free data keep to their digits only.
    return (fit.freedom > 0) & (fit.squares > np.maximum(most, 1e-18))
