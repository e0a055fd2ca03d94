"""A channel smoothed: its value and first two derivatives at every sample, each with its sigma."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.smoother import covariance, mean, precision
from rr_opt.recordings.time_step import time_step

Array = NDArray[np.float64]

_CLOSEST, _FARTHEST = 1e-3, 1e3
"""Neighbours are taken to be at least and at most so many steps apart. Across more than the latter
they say nothing of each other, and arithmetic would suffer."""
_FEWEST = 4


@dataclass(frozen=True)
class Smooth:
    """The posterior at every time (n,): units of the signal, per s, per s^2.

    leverage  how much a sample moves its own smoothed value; 0 where there was no sample
    """

    value: Array
    first: Array
    second: Array
    value_sigma: Array
    first_sigma: Array
    second_sigma: Array
    leverage: Array


def smoothed(t: Array, y: Array, sigma: Array | float, ratio: float) -> Smooth:
    """y (n,) at the increasing times t (n,), s, smoothed; NaN is a time without a sample.

    sigma: the samples' standard deviations, (n,) or one. ratio: q over sigma's median squared, in
    steps of time (`strength`). All is NaN if there are fewer than four samples.
    """
    n = len(y)
    known = np.isfinite(y)
    if known.sum() < _FEWEST:
        none = np.full(n, np.nan)
        return Smooth(none, none, none, none, none, none, np.zeros(n))
    tau = time_step(t)
    sigma = np.broadcast_to(np.asarray(sigma, float), (n,))
    usual = float(np.median(sigma[known]))
    weight = np.where(known, (usual / np.where(sigma > 0, sigma, usual)) ** 2, 0.0)
    # A parabola off, and the noise as unit: what is left is small, and the arithmetic exact.
    u = (t - t[known].mean()) / tau
    trend = np.polynomial.Polynomial.fit(u[known], y[known], 2)
    left = np.where(known, y - trend(u), 0.0) / usual
    P = precision(np.clip(np.diff(u), _CLOSEST, _FARTHEST), ratio, weight)
    state = mean(P, weight * left) * usual
    spread = covariance(P)
    sigmas = usual * np.sqrt(np.maximum(spread[:, range(3), range(3)], 0.0))
    return Smooth(
        state[:, 0] + trend(u),
        (state[:, 1] + trend.deriv(1)(u)) / tau,
        (state[:, 2] + trend.deriv(2)(u)) / tau**2,
        sigmas[:, 0], sigmas[:, 1] / tau, sigmas[:, 2] / tau**2,
        weight * spread[:, 0, 0],
    )  # fmt: skip
