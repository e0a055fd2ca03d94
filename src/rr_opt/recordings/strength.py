"""How fast a signal may bend, from the signal: the strength q of its third derivative's noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from rr_opt.recordings.wiener import innovations

Array = NDArray[np.float64]

RATIOS = (1e-7, 1e2)
"""Bounds of q over the variance of a sample, in steps of time. Below the first, arithmetic suffers;
a spline of that strength still takes up 1 Hz at 100 samples a second."""

_FEWEST, _WARM = 90, 300
"""Samples needed, and those after which the filter's start from rest is forgotten at the first
bound; of a short recording a quarter is left out."""
_MOST = 20_000
_OUTLYING = 9.0
"""An innovation counts at most as one of three standard deviations."""


def strength(y: Array, sigma: float) -> float:
    """q over sigma^2, in steps of time, by maximum likelihood.

    y: (n,), equal steps, NaN where there is nothing; sigma: its noise's standard deviation. What
    is missing is bridged by a line. Innovations beyond three standard deviations are cut to that,
    so that what outliers are left do not count as bends.
    """
    known = np.isfinite(y)
    if known.sum() < _FEWEST or not sigma > 0:
        return float(np.sqrt(RATIOS[0] * RATIOS[1]))
    index = np.arange(len(y))
    z = np.interp(index, index[known], y[known])[:_MOST] / sigma
    z = z - np.polyval(np.polyfit(index[: len(z)], z, 2), index[: len(z)])
    use = known[: len(z)].copy()
    use[: min(_WARM, len(z) // 4)] = False

    def cost(log_ratio: float) -> float:
        off, variance = innovations(z, float(np.exp(log_ratio)))
        scaled = np.minimum(off[use] ** 2 / variance, _OUTLYING)
        return float(np.log(variance) + scaled.mean())

    low, high = np.log(RATIOS)
    grid = np.linspace(low, high, 16)
    start = int(np.argmin([cost(one) for one in grid]))
    bounds = (grid[max(start - 1, 0)], grid[min(start + 1, 15)])
    best = minimize_scalar(cost, bounds=bounds, method="bounded", options={"xatol": 0.05})
    return float(np.exp(best.x))
