"""Outliers: samples that the motion does not explain, but never those at a kink.

A sample is suspected if it is off the smooth curve through all others by more than Gaussian noise
is once in a million. The worst in its neighbourhood is removed, the curve is fitted again, and so
on until none is left; then each removed sample is tried again. Where the motion has a kink (a
start, a servo at its rate limit) a smooth curve through both sides misses good samples, but one
side alone predicts them: a sample is an outlier only if neither side does.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d
from scipy.special import ndtri

from rr_opt.array import Array
from rr_opt.recordings.noise import NoiseEstimate, noise_of, spread_at
from rr_opt.recordings.smoothing import bounded, smoothed, strength
from rr_opt.recordings.time_axis import in_steps

_CHANCE, _COLOURED = 1e-4, 1.2
_STRIDES = (2, 4, 8)
_LEVELS = 4
"""A channel with fewer levels than this part of its samples comes in steps."""


def usual_noise(y: Array) -> Array:
    """The noise of a channel of which none is stated, (n,); never zero.

    After a filter the fastest differences are too small. The largest over slower ones is then
    used; if part of it is motion, fewer outliers are found, and no good sample is flagged.
    """
    noise = noise_of(y)
    sigma = noise.sigma
    if noise.p_white < _CHANCE and noise.colour > _COLOURED:
        sigma = max(sigma, *np.nan_to_num([spread_at(y, stride) for stride in _STRIDES]))
    size = float(np.nanmax(np.abs(y))) if np.isfinite(y).any() else 1.0
    least = max(1e-9 * size, 1e-12)
    return np.full(len(y), max(sigma, least) if math.isfinite(sigma) else max(size, least))


def step_of(y: Array) -> float:
    """The resolution of the values y (n,), in their unit; 0 if they are not rounded."""
    known = y[np.isfinite(y)]
    levels = np.unique(np.round(known, 12))
    if len(levels) < 3 or len(levels) * _LEVELS > len(known):
        return 0.0
    apart = np.diff(levels)
    step = float(np.median(apart))
    off = np.abs(apart / step - np.round(apart / step))
    return step if off.max() < 1e-3 else 0.0


_NEIGHBOURS = 9
_REACH = 21.0
"""Steps of time within which these neighbours have to be."""


def misses(
    u: Array, y: Array, good: NDArray[np.bool_], rows: NDArray[np.int_], noise: Array
) -> tuple[Array, Array]:
    """Deviation of y[rows] from a parabola through its neighbours, in standard deviations.

    u: (n,), times in steps; good: (n,), what may be a neighbour; noise: (n,), standard deviations.
    Two arrays (m,): from the nine before and the nine after; infinite where they are not there.
    """
    at = np.flatnonzero(good)
    place = np.searchsorted(at, rows)
    after = place + good[rows]
    left = place[:, None] - _NEIGHBOURS + np.arange(_NEIGHBOURS)
    right = after[:, None] + np.arange(_NEIGHBOURS)
    return _off(u, y, at, left, rows, noise), _off(u, y, at, right, rows, noise)


def _off(
    u: Array, y: Array, at: NDArray[np.int_], picked: NDArray[np.int_], rows: NDArray[np.int_],
    noise: Array,
) -> Array:  # fmt: skip
    off = np.full(len(rows), np.inf)
    whole = (picked >= 0).all(axis=1) & (picked < len(at)).all(axis=1)
    if not whole.any():
        return off
    near, row = at[picked[whole]], rows[whole]
    since = u[near] - u[row][:, None]
    scale = np.maximum(np.abs(since).max(axis=1), 1e-9)
    V = (since / scale[:, None])[..., None] ** np.arange(3)
    # The constant of the parabola through the neighbours is its value at the sample.
    G = np.linalg.inv(np.swapaxes(V, 1, 2) @ V + 1e-12 * np.eye(3))
    weight = np.einsum("nj,nkj->nk", G[:, 0], V)
    predicted = (weight * y[near]).sum(axis=1)
    sigma = np.sqrt(noise[row] ** 2 + (weight**2 * noise[near] ** 2).sum(axis=1))
    off[whole] = np.where(scale <= _REACH, np.abs(y[row] - predicted) / sigma, np.inf)
    return off


FALSE_ALARM = 1e-6
"""The share of good samples, with Gaussian noise, that the smooth curve suspects."""
_SUSPECT = float(-ndtri(FALSE_ALARM / 2))
_ONE_SIDE = 3.5
"""Largest deviation of a good sample from a parabola through one side, which misses curvature."""
_ROUNDS = 12
_NEAR = 40
"""Samples to either side that each round examines again."""
_LEAST = 0.5
"""Share of the stated noise; anything finer is not sought."""


@dataclass(frozen=True)
class Outliers:
    """The outliers of a channel.

    outlier  (n,)
    noise    of the others
    sigma    usual standard deviation that samples were allowed
    """

    outlier: NDArray[np.bool_]
    noise: NoiseEstimate
    sigma: float


def outliers(t: Array, y: Array, sigma: Array) -> Outliers:
    """The outliers of y (n,) at t (n,), s; NaN is no sample. sigma: (n,), as stated."""
    suspect = np.zeros(len(y), bool)
    known = np.isfinite(y)
    noise = noise_of(y)
    if known.sum() < 4 or not np.nanmax(np.abs(y)) < 1e12:
        return Outliers(suspect, noise, float(np.median(sigma)))
    scale, sigma = 1.0, bounded(y, sigma)
    usual = float(np.median(sigma))
    for again in range(3):
        left = np.where(suspect, np.nan, y)
        noise = noise_of(left) if again else noise
        least = max(_LEAST, 1e-6 * float(np.nanstd(y)) / usual)
        scale = max(noise.sigma / usual, least) if np.isfinite(noise.sigma) else 1.0
        ratio = strength(left, scale * usual)
        before, suspect = suspect, _suspects(t, y, scale * sigma, ratio)
        if (suspect == before).all():
            break
    return Outliers(_foretold(t, y, suspect, scale * sigma), noise, scale * usual)


def _suspects(t: Array, y: Array, sigma: Array, ratio: float) -> NDArray[np.bool_]:
    out = np.zeros(len(y), bool)
    look = np.ones(len(y), bool)
    for _ in range(_ROUNDS):
        rows = np.flatnonzero(look)
        off = np.zeros(len(y))
        off[rows] = _outliers_off(t[rows], y[rows], out[rows], sigma[rows], ratio)
        # Of neighbours that are all off, only the worst is known to be at fault.
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


def _outliers_off(t: Array, y: Array, out: NDArray[np.bool_], sigma: Array, ratio: float) -> Array:
    """How far each sample is off the curve through the others, in standard deviations."""
    curve = smoothed(t, np.where(out, np.nan, y), sigma, ratio)
    # A sample pulls the curve: its distance from the curve through the others is larger.
    rest = np.maximum(1 - curve.leverage, 1e-6)
    scale = np.where(out, np.hypot(sigma, curve.sigma), sigma * np.sqrt(rest))
    return np.nan_to_num(np.abs(y - curve.value) / scale, nan=0.0)


def _foretold(t: Array, y: Array, suspect: NDArray[np.bool_], sigma: Array) -> NDArray[np.bool_]:
    rows = np.flatnonzero(suspect)
    if not len(rows):
        return suspect
    before, after = misses(in_steps(t), y, np.isfinite(y) & ~suspect, rows, sigma)
    kept = np.minimum(before, after) > _ONE_SIDE
    # Without neighbours on either side nothing is known.
    kept &= np.isfinite(before) | np.isfinite(after)
    outlier = suspect.copy()
    outlier[rows[~kept]] = False
    return outlier
