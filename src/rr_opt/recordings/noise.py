"""How noisy a channel is, from the channel alone, and whether its noise is white.

The sixth difference of a smooth motion is next to nothing, that of white noise is sqrt(924) times
its standard deviation. Differences over two samples see the noise at half the frequency: with
white noise both agree; if a filter removed the fastest noise, the first is smaller. Extreme
differences are cut off at three standard deviations, so that a kink or a jump does not count.
The uncertainties are those of the mean over pieces of the recording.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import erf, stdtr

from rr_opt.array import Array

_ORDER = 6
_SIGNS = np.array([(-1.0) ** i * math.comb(_ORDER, i) for i in range(_ORDER + 1)])
_NORM = math.sqrt(math.comb(2 * _ORDER, _ORDER))
_CUT = 3.0
_KEPT = erf(_CUT / math.sqrt(2)) - _CUT * math.sqrt(2 / math.pi) * math.exp(-(_CUT**2) / 2)
_KEPT /= erf(_CUT / math.sqrt(2))
"""Variance of a normal that is cut off at three standard deviations."""
_OVERLAP = math.comb(4 * _ORDER, 2 * _ORDER) / math.comb(2 * _ORDER, _ORDER) ** 2
"""Number of differences worth one independent one."""
_PIECES, _SHORTEST = 20, 60
_SURE = 4.0
"""Standard deviations of the estimate beyond which the noise certainly differs."""


@dataclass(frozen=True)
class NoiseEstimate:
    """The noise of a channel, in its unit; NaN where there are too few samples.

    sigma    standard deviation of the noise at the highest frequencies
    error    of sigma, one standard deviation
    slower   standard deviation of the noise at half those frequencies; white noise has the same
    p_white  probability that sigma and slower of white noise differ by as much
    """

    sigma: float
    error: float
    slower: float
    p_white: float

    @property
    def colour(self) -> float:
        """slower over sigma; 1 for white noise."""
        return self.slower / self.sigma if self.sigma > 0 else math.nan

    def times(self, stated: float) -> float:
        """Its ratio to the stated noise; 1 where the difference may be chance."""
        if not abs(self.sigma - stated) > _SURE * self.error:
            return 1.0
        return self.sigma / stated if stated > 0 else math.nan


def noise_of(y: Array) -> NoiseEstimate:
    """The noise of y (n,), samples at equal steps, NaN where there is none."""
    quick, slow = _differences(y, 1), _differences(y, 2)
    sigma, slower = float(_spread(quick)), float(_spread(slow))
    known = int(np.isfinite(quick).sum())
    if not sigma > 0 or not slower > 0:
        return NoiseEstimate(sigma, math.nan, slower, math.nan)
    pieces = min(_PIECES, known // _SHORTEST)
    relative = math.sqrt(_OVERLAP / (2 * known))
    if pieces < 4:
        return NoiseEstimate(sigma, sigma * relative, slower, math.nan)
    p_white, between = math.nan, relative
    spreads = _spread(np.stack([_in_pieces(one, len(quick), pieces) for one in (quick, slow)]))
    one, two = spreads[:, (spreads > 0).all(axis=0)]
    if len(one) >= 4:
        both = np.log([one, two / one])
        spread = both.std(axis=1, ddof=1) / math.sqrt(len(one))
        between = max(float(spread[0]), relative)
        p_white = float(2 * stdtr(len(one) - 1, -abs(both[1].mean()) / max(spread[1], 1e-12)))
    return NoiseEstimate(sigma, sigma * between, slower, p_white)


def _in_pieces(d: Array, n: int, pieces: int) -> Array:
    """d (m,), the first of n places, in rows of equal length, padded with NaN."""
    width = -(-n // pieces)
    whole = np.concatenate([d, np.full(n - len(d), np.nan)])
    ends = n - (width - 1) * np.arange(width * pieces - n)
    return np.insert(whole, ends, np.nan).reshape(pieces, width)


def spread_at(y: Array, stride: int) -> float:
    """The noise of y (n,) by differences over `stride` samples; NaN if there are too few."""
    return float(_spread(_differences(y, stride)))


def _differences(y: Array, stride: int) -> Array:
    """Sixth differences over `stride` samples, scaled to the noise's standard deviation; NaN if
    there are none."""
    n = len(y) - _ORDER * stride
    if n < 1:
        return np.full(1, np.nan)
    total = np.zeros(n)
    for i, sign in enumerate(_SIGNS):
        total += sign * y[i * stride : i * stride + n]
    return total / _NORM


def _spread(d: Array) -> Array:
    """Robust standard deviation of the bulk of d (..., n); NaN for fewer than 10."""
    d = np.sort(np.where(np.isfinite(d), np.abs(d), np.nan))  # NaN last
    known = np.isfinite(d).sum(axis=-1, keepdims=True)
    middle = np.concatenate([(known - 1) // 2, known // 2], axis=-1)
    sigma = np.take_along_axis(d, middle, axis=-1).mean(axis=-1, keepdims=True) / 0.6745
    squares = np.cumsum(d**2, axis=-1)
    for _ in range(5):
        inside = (d <= _CUT * sigma).sum(axis=-1, keepdims=True)
        square = np.take_along_axis(squares, inside - 1, axis=-1)
        sigma = np.sqrt(square / (np.maximum(inside, 1) * _KEPT))
    return np.where(known < 10, np.nan, sigma)[..., 0]
