"""One signal seen on two clocks: by how much one is ahead, how fast it drifts, with intervals.

phi as seen at t is matched with a reference, the command or the servo's log, at the time

    u = t + offset + drift (t - t_mid),   phi = bias + scale (g(u) - mean g)

by nonlinear least squares. Scale and bias are free, as a servo that lags also moves less. The
covariance is the sandwich with Bartlett's weights over lags (W. K. Newey and K. D. West,
Econometrica 55, 1987, pp. 703-708), so that what is left may be coloured.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from rr_opt.array import Array

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
    from scipy.signal import correlate

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


Reference = Callable[[Array], tuple[Array, Array]]
"""The reference and its rate at times (m,), rad and rad/s; NaN where it is not known."""

_FEWEST = 20
_COVERED = 1.959964
"""Standard deviations on either side of 95 %."""


@dataclass(frozen=True)
class ClockFit:
    """The reference's time is t + offset + drift (t - t_mid).

    offset, drift  s, and s per s
    scale, bias    of phi against the reference; 1, and rad
    sigma          standard deviations of those four, in this order
    t_mid          the middle of the samples that were used, s
    residual       root mean square of what is left, rad
    samples        how many were used
    """

    offset: float
    drift: float
    scale: float
    bias: float
    sigma: tuple[float, float, float, float]
    t_mid: float
    residual: float
    samples: int

    def interval(self, which: int = 0) -> tuple[float, float]:
        """95 % interval of offset (0), drift (1), scale (2) or bias (3)."""
        value = (self.offset, self.drift, self.scale, self.bias)[which]
        half = _COVERED * self.sigma[which]
        return value - half, value + half


def clock_fit(t: Array, phi: Array, reference: Reference, offset: float) -> ClockFit | None:
    """The fit that starts from an offset, s; None if there is too little to fit.

    t, phi: (n,), s and rad, NaN where there is no sample.
    """
    known = np.isfinite(phi) & np.isfinite(reference(t + offset)[0])
    if known.sum() < _FEWEST:
        return None
    t, phi = t[known], phi[known]
    t_mid = float((t[0] + t[-1]) / 2)
    since = t - t_mid
    middle = float(np.nanmean(reference(t + offset)[0]))

    def off(p: Array) -> Array:
        g, _ = reference(t + p[0] + p[1] * since)
        return np.nan_to_num(p[3] + middle + p[2] * (g - middle) - phi)

    def slopes(p: Array) -> Array:
        g, rate = reference(t + p[0] + p[1] * since)
        outside = ~np.isfinite(g)
        J = np.stack([p[2] * rate, p[2] * rate * since, g - middle, np.ones_like(g)], 1)
        J[outside] = 0.0
        return J

    size = float(np.ptp(phi))
    if not size > 0:
        return None
    start = [offset, 0.0, 1.0, 0.0]
    found = least_squares(off, start, slopes, method="lm", x_scale="jac")  # type: ignore[arg-type]
    left, J = off(found.x), slopes(found.x)
    variances = _variances(J, left)
    if variances is None:
        return None
    sigma = np.sqrt(variances)
    o, d, s, b = (float(value) for value in found.x)
    rms = float(np.sqrt(np.mean(left**2)))
    return ClockFit(o, d, s, b, tuple(sigma.tolist()), t_mid, rms, len(t))  # type: ignore[arg-type]


def _variances(J: Array, left: Array) -> Array | None:
    """Of the unknowns: the sandwich's, and not below those for white noise."""
    scale = np.linalg.norm(J, axis=0)
    if not (scale > 0).all():
        return None
    unit = J / scale
    information = unit.T @ unit
    if np.linalg.cond(information) > 1e10:
        return None
    score = unit * left[:, None]
    lags = min(round(1.5 * len(left) ** (1 / 3)), len(left) // 4)
    meat = score.T @ score
    for lag in range(1, lags + 1):
        later = score[lag:].T @ score[:-lag]
        meat += (1 - lag / (lags + 1)) * (later + later.T)
    bread = np.linalg.inv(information)
    white = np.diag(bread) * float(left @ left) / (len(left) - len(scale))
    # The estimate over lags falls short by chance as often as it exceeds: the larger is taken.
    return np.maximum(np.diag(bread @ meat @ bread), white) / scale**2
