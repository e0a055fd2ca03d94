"""A smooth signal of which nothing is known: its third derivative is white noise.

The state is the signal, its first and its second derivative, in steps of time. Smoothing with this
prior is the quintic smoothing spline; its one number q, the strength of the noise, is the spline's
smoothing parameter. (G. Wahba, J. R. Stat. Soc. B 40, 1978, pp. 364-372.)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs
from scipy.special import factorial

Array = NDArray[np.float64]

ORDER = 3


def transition(step: Array) -> Array:
    """A (m, 3, 3): how the state moves on by `step` (m,), in units of the time step."""
    A = np.zeros((len(step), ORDER, ORDER))
    for i in range(ORDER):
        for j in range(i, ORDER):
            A[:, i, j] = step ** (j - i) / factorial(j - i)
    return A


def diffusion(step: Array) -> Array:
    """Q (m, 3, 3): covariance of what is added within `step` (m,), for q = 1."""
    Q = np.zeros((len(step), ORDER, ORDER))
    for i in range(ORDER):
        for j in range(ORDER):
            p, r = ORDER - 1 - i, ORDER - 1 - j
            Q[:, i, j] = step ** (p + r + 1) / ((p + r + 1) * factorial(p) * factorial(r))
    return Q


def innovations(y: Array, ratio: float) -> tuple[Array, float]:
    """What each sample (n,) adds to what those before it foretell, and its variance.

    ratio: q over the variance of a sample, in steps of time. The variance is in units of that of
    a sample. From equal steps, with the filter's gain at its limit: the third difference of y has
    the covariances of a quintic B-spline, times ratio, and of the third difference of white noise;
    their spectral factor is what whitens it.
    """
    covariances = np.zeros(2 * ORDER + 1)
    covariances[1:-1] = ratio * np.array([1.0, 26.0, 66.0, 26.0, 1.0]) / 120
    covariances += np.array([-1.0, 6.0, -15.0, 20.0, -15.0, 6.0, -1.0])
    roots = np.roots(covariances)
    factor = np.poly(roots[np.argsort(np.abs(roots))[:ORDER]]).real
    # The outermost covariance, -1, is the variance times the factor's last coefficient.
    return _whitened(y, np.asarray(factor, float)), float(-1 / factor[-1])


def _whitened(y: Array, factor: Array) -> Array:
    """The third difference of y (n,), from rest, with the filter `factor` (4,) taken off."""
    third = y.copy()
    for lag, share in ((1, -3.0), (2, 3.0), (3, -1.0)):
        third[lag:] += share * y[:-lag]
    # The filter as a triangular system of four bands: scipy.signal takes half a second to load.
    bands = np.repeat(factor[:, None], len(y), axis=1)
    (solve,) = get_lapack_funcs(("tbtrs",), (bands, third))
    solved, _ = solve(bands, third[:, None], uplo="L")
    return np.asarray(solved, float)[:, 0]
