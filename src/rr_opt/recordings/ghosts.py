"""Single markers that are not where their platform is: ghosts, reflections, jumps.

In a frame that does not fit, each marker is left out in turn, then each pair. The smallest set
whose absence makes the frame fit is to blame. Where several of one size do, none can be told from
the other, and all of them are left out. A frame that nothing makes fit is not taken as data.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.bodies import Bodies
from rr_opt.recordings.fit_noise import beyond
from rr_opt.recordings.rigid import fit

Array = NDArray[np.float64]

_AS_GOOD = 20.0
"""Sums of squares, over the variance, that are closer than this do not tell two sets apart."""


@dataclass(frozen=True)
class Ghosts:
    """Markers left out.

    seen      (n, k, 2), m, NaN where a marker is left out
    out       (n, k), which ones
    left_out  (n, k), where they were seen, x + iy, m; NaN of those that were not left out
    lost      (m,), frames that do not fit whatever is left out
    """

    seen: Array
    out: NDArray[np.bool_]
    left_out: NDArray[np.complex128]
    lost: NDArray[np.int_]


def without_ghosts(bodies: Bodies, seen: Array, sigma: float, most: int = 2) -> Ghosts:
    """The markers (n, k, 2) without those that do not fit; sigma: of a coordinate, m.

    most: how many of a frame may be left out together.
    """
    left = np.flatnonzero(beyond(fit(bodies, seen), sigma))
    given, seen, out = seen, seen.copy(), np.zeros(seen.shape[:2], bool)
    for size in range(1, most + 1):
        if not len(left):
            break
        blamed, solved = _blamed(bodies, seen[left], sigma, size)
        rows = left[solved]
        out[rows] = blamed[solved]
        seen[rows] = np.where(out[rows, :, None], np.nan, seen[rows])
        left = left[~solved]
    there = np.where(out, given[..., 0] + 1j * given[..., 1], np.nan)
    return Ghosts(seen, out, there, left)


def _blamed(
    bodies: Bodies, seen: Array, sigma: float, size: int
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    n, k = seen.shape[:2]
    sets = [list(one) for one in combinations(range(k), size)]
    squares = np.full((len(sets), n), np.inf)
    for row, one in enumerate(sets):
        here = np.isfinite(seen[:, one, 0]).all(axis=1)
        tried = seen[here].copy()
        tried[:, one] = np.nan
        fitted = fit(bodies, tried)
        fits = ~beyond(fitted, sigma) & (fitted.freedom > 0)
        squares[row, here] = np.where(fits, fitted.squares, np.inf)
    best = squares.min(axis=0)
    chosen = squares <= best + _AS_GOOD * sigma**2
    solved = np.isfinite(best)
    member = np.array([[i in one for i in range(k)] for one in sets])
    return (chosen.T.astype(int) @ member.astype(int)) > 0, solved
