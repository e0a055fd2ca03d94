"""A signal and its derivatives from noisy samples, with what is known of each.

The state at every sample (signal, first and second derivative) is Gaussian with a block-tridiagonal
precision. Its mean is one banded Cholesky solve. Its covariances come from cyclic reduction: every
other block is eliminated, all at once, until one is left; then the blocks come back in the
opposite order with their covariances. Both are exact for any times and gaps, without a loop over
samples.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from rr_opt.recordings.wiener import ORDER, diffusion, transition

Array = NDArray[np.float64]

_VAGUE = 1e-9
"""Precision of the signal and its derivatives before any sample, relative to a sample's."""


@dataclass(frozen=True)
class Precision:
    """A block-tridiagonal matrix: blocks on the diagonal (n, 3, 3), and above it (n - 1, 3, 3)."""

    diagonal: Array
    above: Array


def precision(step: Array, ratio: float, weight: Array) -> Precision:
    """That of the states at n samples.

    step: (n - 1,), between samples; ratio: q over a sample's variance; weight: (n,), 1 over the
    samples' variances relative to that variance, 0 where there is no sample.
    """
    A = transition(step)
    # Q(step) is Q(1) between two diagonal scalings, which are inverted without loss.
    scale = step[:, None] ** -(ORDER - 0.5 - np.arange(ORDER))
    W = scale[:, :, None] * np.linalg.inv(diffusion(np.ones(1))[0]) * scale[:, None] / ratio
    WA = W @ A
    D = np.zeros((len(weight), ORDER, ORDER))
    D[:, 0, 0] = weight
    D += _VAGUE * np.eye(ORDER)
    D[1:] += W
    D[:-1] += np.swapaxes(A, 1, 2) @ WA
    return Precision(D, -np.swapaxes(WA, 1, 2))


def mean(P: Precision, pull: Array) -> Array:
    """The states' means (n, 3); pull: (n,), weight times sample."""
    n = len(pull)
    size = ORDER * n
    band = np.zeros((2 * ORDER, size))
    for i in range(ORDER):
        for j in range(ORDER):
            columns = np.arange(n) * ORDER + j
            if i <= j:
                band[2 * ORDER - 1 + i - j, columns] = P.diagonal[:, i, j]
            band[ORDER - 1 + i - j, columns[1:]] = P.above[:, i, j]
    right = np.zeros(size)
    right[::ORDER] = pull
    return solveh_banded(band, right, overwrite_ab=True, check_finite=False).reshape(n, ORDER)


def covariance(P: Precision) -> Array:
    """The states' covariances (n, 3, 3)."""
    return _covariance(P.diagonal, P.above)[0]


def _covariance(D: Array, B: Array) -> tuple[Array, Array]:
    """Diagonal blocks of the inverse, and those above them."""
    n = len(D)
    if n == 1:
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
    S, C = _covariance(reduced, coupling)
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
