"""Markers whose names were exchanged by the capture system, found and put right.

A pair of names is exchanged in the frames that do not fit; where the frame then fits, the names
were swapped. A name that sits on another marker while its own is missing is found in the same way.
Nothing depends on the frames before, so a swap may last to the end of the file.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.bodies import Bodies
from rr_opt.recordings.fit_noise import beyond, marker_noise
from rr_opt.recordings.rigid import fit

Array = NDArray[np.float64]

_SAMPLE = 200
"""Frames on which the pairs are ranked, the likeliest to be tried first."""
_BETTER = 5.0
"""How many times smaller a pair must make the noise of a whole recording to be believed."""


@dataclass(frozen=True)
class Swap:
    """Two columns of the bodies whose names were exchanged, and the frames (m,) where they were."""

    pair: tuple[int, int]
    frames: NDArray[np.int_]


def swapped_throughout(bodies: Bodies, seen: Array) -> tuple[int, int] | None:
    """A pair that is exchanged in most of the recording, or in the layout."""
    rows = np.flatnonzero(np.isfinite(seen[..., 0]).sum(axis=1) > 3)
    sample = seen[rows[:: max(1, len(rows) // _SAMPLE)]]
    if not len(sample):
        return None
    own = marker_noise(fit(bodies, sample))
    tried = {pair: marker_noise(fit(bodies, _exchanged(sample, pair))) for pair in _pairs(bodies)}
    tried = {pair: sigma for pair, sigma in tried.items() if np.isfinite(sigma)}
    best = min(tried, key=lambda pair: tried[pair], default=None)
    return best if best and tried[best] * _BETTER < own else None


def put_right(bodies: Bodies, seen: Array, sigma: float) -> tuple[Array, list[Swap]]:
    """The markers (n, k, 2) with the names put right, and what was exchanged.

    sigma: of a marker's coordinate, m.
    """
    first = fit(bodies, seen)
    left, freedom = np.flatnonzero(beyond(first, sigma)), first.freedom
    if not len(left):
        return seen, []
    seen, found = seen.copy(), []
    for pair in _ranked(bodies, seen[left], sigma):
        if not len(left):
            break
        tried = _exchanged(seen[left], pair)
        fitted = fit(bodies, tried)
        # A marker that no fit uses any more fits nothing.
        solved = ~beyond(fitted, sigma) & (fitted.freedom >= freedom[left])
        if solved.any():
            seen[left[solved]] = tried[solved]
            found.append(Swap(pair, left[solved]))
            left = left[~solved]
    return seen, found


def _ranked(bodies: Bodies, seen: Array, sigma: float) -> list[tuple[int, int]]:
    sample = seen[:: max(1, len(seen) // _SAMPLE)]

    def solves(pair: tuple[int, int]) -> int:
        return int((~beyond(fit(bodies, _exchanged(sample, pair)), sigma)).sum())

    return sorted(_pairs(bodies), key=solves, reverse=True)


def _pairs(bodies: Bodies) -> list[tuple[int, int]]:
    return list(combinations(range(len(bodies.labels)), 2))


def _exchanged(seen: Array, pair: tuple[int, int]) -> Array:
    i, j = pair
    order = np.arange(seen.shape[1])
    order[[i, j]] = j, i
    return seen[:, order]
