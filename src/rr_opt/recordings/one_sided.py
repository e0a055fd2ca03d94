"""Whether a sample follows from those before it, or from those after it.

Where the motion has a kink (a start, a servo at its rate limit) a smooth curve through both sides
misses good samples. But one side alone foretells them: a sample is an outlier only if neither does.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_NEIGHBOURS = 9
_REACH = 21.0
"""Steps of time within which they have to be."""


def misses(
    u: Array, y: Array, good: NDArray[np.bool_], rows: NDArray[np.int_], noise: Array
) -> tuple[Array, Array]:
    """By how many standard deviations y[rows] is off a parabola through its neighbours.

    u: (n,), times in steps; good: (n,), what may be a neighbour; noise: (n,), standard deviations.
    Two arrays (m,): from the nine before and the nine after; infinite where they are not there.
    """
    at = np.flatnonzero(good)
    place = np.searchsorted(at, rows)
    after = place + ((place < len(at)) & (at[np.minimum(place, len(at) - 1)] == rows))
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
    scale = np.abs(since).max(axis=1)
    V = (since / scale[:, None])[..., None] ** np.arange(3)
    # The constant of the parabola through the neighbours is its value at the sample.
    G = np.linalg.inv(np.swapaxes(V, 1, 2) @ V + 1e-12 * np.eye(3))
    weight = np.einsum("nj,nkj->nk", G[:, 0], V)
    told = (weight * y[near]).sum(axis=1)
    sigma = np.sqrt(noise[row] ** 2 + (weight**2 * noise[near] ** 2).sum(axis=1))
    off[whole] = np.where(scale <= _REACH, np.abs(y[row] - told) / sigma, np.inf)
    return off
