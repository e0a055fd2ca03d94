"""A recorded channel smoothed: signal, its sigma, and derivative at every sample.

The signal is modelled as one whose third derivative is white noise, measured with the sensor's
white noise. Smoothing with this prior is the quintic smoothing spline, and the strength of the
process noise its smoothing parameter (G. Wahba, J. R. Stat. Soc. B 40, 1978, pp. 364-372), set by
maximum likelihood, with no window to choose. Where the motion has a kink, as at a start from rest,
the true derivative jumps and the error is larger than its sigma.

The states (signal, first and second derivative, in steps of time) are Gaussian with a
block-tridiagonal precision. Their mean is one banded Cholesky solve. Their covariances come from
cyclic reduction: every other block is eliminated, all at once, until one is left; then the blocks
come back in the opposite order. Both are exact for any times and gaps, without a loop over samples.
"""

from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from math import factorial

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs, solveh_banded
from scipy.optimize import minimize_scalar

from rr_opt.array import Array
from rr_opt.recordings.time_axis import in_steps, time_step

ORDER = 3


def transition(step: Array) -> Array:
    """A (m, 3, 3): transition of the state over `step` (m,), in units of the time step."""
    A = np.zeros((len(step), ORDER, ORDER))
    for i in range(ORDER):
        for j in range(i, ORDER):
            A[:, i, j] = step ** (j - i) / factorial(j - i)
    return A


def diffusion(step: Array) -> Array:
    """Q (m, 3, 3): covariance of the process noise over `step` (m,), for q = 1."""
    Q = np.zeros((len(step), ORDER, ORDER))
    for i in range(ORDER):
        for j in range(ORDER):
            p, r = ORDER - 1 - i, ORDER - 1 - j
            Q[:, i, j] = step ** (p + r + 1) / ((p + r + 1) * factorial(p) * factorial(r))
    return Q


def innovations(y: Array, ratio: float) -> tuple[Array, float]:
    """The innovation of each sample (n,), given those before it, and its variance.

    ratio: q over the variance of a sample, in steps of time. The variance is in units of that of
    a sample. From equal steps, with the filter's gain at its limit: the third difference of y has
    the covariances of a quintic B-spline, times ratio, and of the third difference of white noise;
    their spectral factor is what whitens it.
    """
    factor, variance = _spectral_factor(ratio)
    return _whitened(y, factor), variance


@lru_cache(maxsize=64)
def _spectral_factor(ratio: float) -> tuple[Array, float]:
    """The filter (4,) that whitens a third difference, and the innovations' variance; see above."""
    covariances = np.zeros(2 * ORDER + 1)
    covariances[1:-1] = ratio * np.array([1.0, 26.0, 66.0, 26.0, 1.0]) / 120
    covariances += np.array([-1.0, 6.0, -15.0, 20.0, -15.0, 6.0, -1.0])
    roots = np.roots(covariances)
    factor = np.poly(roots[np.argsort(np.abs(roots))[:ORDER]]).real
    # The outermost covariance, -1, is the variance times the factor's last coefficient.
    return np.asarray(factor, float), float(-1 / factor[-1])


def _whitened(y: Array, factor: Array) -> Array:
    """The third difference of y (n,), from rest, with the filter `factor` (4,) inverted."""
    third = y.copy()
    for lag, share in ((1, -3.0), (2, 3.0), (3, -1.0)):
        third[lag:] += share * y[:-lag]
    # The filter as a triangular system of four bands: scipy.signal takes half a second to load.
    bands = np.repeat(factor[:, None], len(y), axis=1)
    (solve,) = get_lapack_funcs(("tbtrs",), (bands, third))
    solved, _ = solve(bands, third[:, None], uplo="L")
    return np.asarray(solved, float)[:, 0]


_VAGUE = (1e-9, 1e-6, 1e-3, 1.0)
"""Prior precision of the signal and its derivatives, relative to a sample's. Only few samples at
very uneven times need more than the first against rounding. The last always suffices: no entry of
the precision is larger than 1e13."""


def precision(step: Array, ratio: float, seen: Array, vague: float) -> tuple[Array, Array]:
    """Precision of the states at n nodes: diagonal blocks (n, 3, 3), and above them (n - 1, 3, 3).

    step: (n - 1,), between nodes; ratio: q over a sample's variance; seen: (n, 3, 3), information
    of the samples at a node on its state, in units of one over that variance.
    """
    A = transition(step)
    # Q(step) is Q(1) between two diagonal scalings, which are inverted without loss.
    scale = step[:, None] ** -(ORDER - 0.5 - np.arange(ORDER))
    W = scale[:, :, None] * np.linalg.inv(diffusion(np.ones(1))[0]) * scale[:, None] / ratio
    WA = W @ A
    D = seen + vague * np.eye(ORDER)
    D[1:] += W
    D[:-1] += np.swapaxes(A, 1, 2) @ WA
    return D, -np.swapaxes(WA, 1, 2)


def mean(D: Array, B: Array, pull: Array) -> Array:
    """The states' means (n, 3) for a precision with these blocks; pull: (n, 3), information vector
    of the samples."""
    n = len(pull)
    size = ORDER * n
    band = np.zeros((2 * ORDER, size))
    for i in range(ORDER):
        for j in range(ORDER):
            columns = np.arange(n) * ORDER + j
            if i <= j:
                band[2 * ORDER - 1 + i - j, columns] = D[:, i, j]
            band[ORDER - 1 + i - j, columns[1:]] = B[:, i, j]
    right = pull.reshape(size)
    return solveh_banded(band, right, overwrite_ab=True, check_finite=False).reshape(n, ORDER)


def covariance(D: Array, B: Array) -> tuple[Array, Array]:
    """The states' covariances (n, 3, 3) for a precision with these blocks, and blocks above."""
    if len(D) == 1:
        return np.asarray(np.linalg.inv(D), float), B
    odd, even = D[1::2], D[::2]
    inverse = np.linalg.inv(odd)
    # Of each odd block: its coupling from the even one before it, and to the one after it.
    before = np.swapaxes(B[::2], 1, 2)
    after = B[1::2]
    G = inverse @ before
    K = inverse[: len(after)] @ after
    reduced = even.copy()
    reduced[: len(odd)] -= np.swapaxes(before, 1, 2) @ G
    reduced[1 : 1 + len(after)] -= np.swapaxes(after, 1, 2) @ K
    coupling = -np.swapaxes(before[: len(after)], 1, 2) @ K
    S, C = covariance(reduced, coupling)
    m, r = len(odd), len(after)
    cross_before = -(G @ S[:m])
    cross_before[:r] -= K @ np.swapaxes(C[:r], 1, 2)
    cross_after = -(G[:r] @ C[:r]) - K @ S[1 : 1 + r]
    own = inverse - cross_before @ np.swapaxes(G, 1, 2)
    own[:r] -= cross_after @ np.swapaxes(K, 1, 2)
    whole, above = np.empty_like(D), np.empty_like(B)
    whole[::2], whole[1::2] = S, own
    above[::2] = np.swapaxes(cross_before, 1, 2)
    above[1::2] = cross_after
    return whole, above


RATIOS = (1e-7, 1e5)
"""Bounds of q over the variance of a sample, in steps of time. Below the first, accuracy suffers; a
spline of that strength still follows 1 Hz at 100 samples a second. At the second the noise is
negligible beside the motion."""

_FEWEST, _WARM = 90, 300
"""Fewest samples needed, and samples after which the filter's initial transient has decayed at the
first bound; of a short recording a quarter is left out."""
_MOST = 20_000
_OUTLYING = 9.0
"""Three standard deviations, squared."""


def strength(y: Array, sigma: float) -> float:
    """q over sigma^2, in steps of time, by maximum likelihood.

    y: (n,), equal steps, NaN where there is nothing; sigma: its noise's standard deviation. Gaps
    are bridged by a line. Beyond three standard deviations innovations have the tails of a Cauchy
    distribution, so that remaining outliers do not count as curvature.
    """
    known = np.isfinite(y)
    if known.sum() < _FEWEST or not sigma > 0:
        return float(np.sqrt(RATIOS[0] * RATIOS[1]))
    index = np.arange(len(y))
    z = np.interp(index, index[known], y[known])[:_MOST] / float(bounded(y, sigma)[0])
    z = z - np.polyval(np.polyfit(index[: len(z)], z, 2), index[: len(z)])
    use = known[: len(z)].copy()
    use[: min(_WARM, len(z) // 4)] = False

    def cost(log_ratio: float) -> float:
        off, variance = innovations(z, float(np.exp(log_ratio)))
        scaled = off[use] ** 2 / variance
        tail = _OUTLYING + 2 * np.log(np.maximum(scaled, _OUTLYING) / _OUTLYING)
        return float(np.log(variance) + np.minimum(scaled, tail).mean())

    low, high = np.log(RATIOS)
    grid = np.linspace(low, high, 16)
    start = int(np.argmin([cost(one) for one in grid]))
    bounds = (grid[max(start - 1, 0)], grid[min(start + 1, 15)])
    best = minimize_scalar(cost, bounds=bounds, method="bounded", options={"xatol": 0.05})
    return float(np.exp(best.x))


_CLOSEST = 0.3
"""Samples within this number of steps of the first of them share a node: the process noise between
them is too small to matter, and much smaller steps would lose accuracy, as the arithmetic has their
fifth power."""
_SMOOTH_FEWEST = 4
_FINEST, _APART = 1e-12, 1e3
"""A sigma below the first, relative to the signal, is lost in rounding. One that differs from the
usual one by more than the second, as a factor, is invalid."""


def bounded(y: Array, sigma: Array | float) -> Array:
    """The standard deviations (n,) of y (n,) within the range of the arithmetic."""
    sigma = np.broadcast_to(np.asarray(sigma, float), y.shape)
    known = np.abs(y[np.isfinite(y)])
    good = sigma[(sigma > 0) & np.isfinite(sigma)]
    least = max(_FINEST * float(known.max(initial=0.0)), 1e-300)
    usual = max(float(np.median(good)) if len(good) else 0.0, least)
    return np.clip(np.where(sigma > 0, sigma, usual), usual / _APART, usual * _APART)


@dataclass(frozen=True)
class Smooth:
    """The posterior at every time (n,), in units of the signal.

    first     derivative, per s
    sigma     standard deviation of the value
    leverage  how much a sample moves its own smoothed value; 0 where there was no sample
    """

    value: Array
    first: Array
    sigma: Array
    leverage: Array


def smoothed(t: Array, y: Array, sigma: Array | float, ratio: float) -> Smooth:
    """y (n,) at the increasing times t (n,), s, smoothed; NaN is a time without a sample.

    sigma: the samples' standard deviations, (n,) or one. ratio: q over sigma's median squared, in
    steps of time (`strength`). All is NaN if there are fewer than four samples.
    """
    n = len(y)
    known = np.isfinite(y)
    if known.sum() < _SMOOTH_FEWEST:
        none = np.full(n, np.nan)
        return Smooth(none, none, none, np.zeros(n))
    tau, u = time_step(t), in_steps(t)
    sigma = bounded(y, sigma)
    usual = float(np.median(sigma[known]))
    weight = np.where(known, (usual / sigma) ** 2, 0.0)
    # Less a parabola, in units of the noise: the rest is small, and the arithmetic accurate.
    trend = np.polynomial.Polynomial.fit(u[known], y[known], 2)
    left = np.where(known, y - trend(u), 0.0) / usual
    node = _nodes(u)
    first = np.flatnonzero(np.diff(node, prepend=-1))
    A = transition(u - u[first][node])
    # Each sample sees the signal of its node's state, moved on to its own time.
    H = A[:, 0]
    seen = np.add.reduceat(weight[:, None, None] * H[:, :, None] * H[:, None], first)
    pull = np.add.reduceat((weight * left)[:, None] * H, first)
    means, covariances = _solved(np.diff(u[first]), ratio, seen, pull)
    state = np.einsum("nij,nj->ni", A, means[node]) * usual
    spread = (A @ covariances[node] @ np.swapaxes(A, 1, 2))[:, 0, 0]
    return Smooth(
        state[:, 0] + trend(u),
        (state[:, 1] + trend.deriv(1)(u)) / tau,
        usual * np.sqrt(np.maximum(spread, 0.0)),
        weight * spread,
    )


def _solved(step: Array, ratio: float, seen: Array, pull: Array) -> tuple[Array, Array]:
    """Means (n, 3) and covariances (n, 3, 3), with the vaguest prior that rounding allows."""
    for vague in _VAGUE[:-1]:
        with suppress(np.linalg.LinAlgError):
            return _posterior(*precision(step, ratio, seen, vague), pull)
    return _posterior(*precision(step, ratio, seen, _VAGUE[-1]), pull)


def _posterior(D: Array, B: Array, pull: Array) -> tuple[Array, Array]:
    return mean(D, B, pull), covariance(D, B)[0]


def _nodes(u: Array) -> NDArray[np.int_]:
    """The node of each of the increasing times u (n,), in steps, from 0."""
    begins = np.diff(u, prepend=-np.inf) >= _CLOSEST
    start = -np.inf
    for i in np.flatnonzero(~begins | np.append(~begins[1:], False)):
        if u[i] - start >= _CLOSEST:
            begins[i], start = True, u[i]
    return np.cumsum(begins) - 1


def derivatives(t: Array, y: Array, sigma: Array | float) -> Smooth:
    """The signal behind y (n,) and its derivative at t (n,), s.

    y: NaN where there is no sample. sigma: standard deviation of the samples, (n,) or one.
    """
    sigma = bounded(y, sigma)
    return smoothed(t, y, sigma, strength(y, float(np.median(sigma))))
