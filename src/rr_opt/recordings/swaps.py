"""Markers whose names were exchanged by the capture system, found and put right.

Two names are exchanged back in the frames that do not fit; where the frame then fits, they were
swapped. A name that sits on another marker while its own is missing is found in the same way. In
frames that no pair mends, and no single marker is to blame for, three names in a ring and two pairs
at once are tried. Nothing depends on the frames before, so a swap may last to the end of the file.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.bodies import Bodies
from rr_opt.recordings.exchanges import Order, members, pairs, put_back, several
from rr_opt.recordings.fit_noise import beyond, marker_noise
from rr_opt.recordings.ghosts import without_ghosts
from rr_opt.recordings.rigid import fit

Array = NDArray[np.float64]

_SAMPLE, _FEW = 200, 20
"""Frames on which the exchanges are ranked, the likeliest to be tried first; where there are many
exchanges, fewer frames."""
_BETTER = 5.0
"""How many times smaller an exchange must make the noise of a whole recording to be believed."""
_ROUGH = 2e-3
"""Markers that keep to their platforms no better are exchanged, or wrong in the layout, m."""


@dataclass(frozen=True)
class Swap:
    """Columns of the bodies whose names were exchanged, and the frames (m,) where they were."""

    members: tuple[int, ...]
    frames: NDArray[np.int_]


def swapped_throughout(bodies: Bodies, seen: Array) -> Order | None:
    """An exchange that is there in most of the recording, or in the layout."""
    rows = np.flatnonzero(np.isfinite(seen[..., 0]).sum(axis=1) > 3)
    sample = seen[rows[:: max(1, len(rows) // _SAMPLE)]]
    if not len(sample):
        return None
    own = marker_noise(fit(bodies, sample))
    found = _quietest(bodies, sample, pairs(len(bodies.labels)), own)
    if found is None and own > _ROUGH:
        few = sample[:: max(1, len(sample) // _FEW)]
        found = _quietest(bodies, few, several(len(bodies.labels)), own)
    return found


def _quietest(bodies: Bodies, seen: Array, orders: list[Order], own: float) -> Order | None:
    tried = {order: marker_noise(fit(bodies, put_back(seen, order))) for order in orders}
    tried = {order: sigma for order, sigma in tried.items() if np.isfinite(sigma)}
    best = min(tried, key=lambda order: tried[order], default=None)
    return best if best and tried[best] * _BETTER < own else None


def put_right(bodies: Bodies, seen: Array, sigma: float) -> tuple[Array, list[Swap]]:
    """The markers (n, k, 2) with the names put right, and what was exchanged.

    sigma: of a marker's coordinate, m.
    """
    first = fit(bodies, seen)
    left, freedom = np.flatnonzero(beyond(first, sigma)), first.freedom
    if not len(left):
        return seen, []
    seen, count = seen.copy(), len(bodies.labels)
    found, left = _exchanged(bodies, seen, left, freedom, sigma, pairs(count))
    if len(left):
        left = left[without_ghosts(bodies, seen[left], sigma, most=1).lost]
        likely = _that_mend(bodies, seen[left], freedom[left], sigma, several(count))
        found += _exchanged(bodies, seen, left, freedom, sigma, likely)[0]
    return seen, found


def _exchanged(
    bodies: Bodies, seen: Array, left: NDArray[np.int_], freedom: NDArray[np.int_], sigma: float,
    orders: list[Order],
) -> tuple[list[Swap], NDArray[np.int_]]:  # fmt: skip
    """Put right, in `seen` itself, the frames `left` that an exchange mends; what is left then."""
    found: list[Swap] = []
    sample = left[:: max(1, len(left) // _SAMPLE)]
    for order in _ranked(bodies, seen[sample], freedom[sample], sigma, orders):
        if not len(left):
            break
        tried = put_back(seen[left], order)
        solved = _mended(bodies, tried, sigma, freedom[left])
        if solved.any():
            seen[left[solved]] = tried[solved]
            found.append(Swap(members(order), left[solved]))
            left = left[~solved]
    return found, left


def _ranked(
    bodies: Bodies, seen: Array, freedom: NDArray[np.int_], sigma: float, orders: list[Order]
) -> list[Order]:
    """Those that mend most frames first."""

    def solves(order: Order) -> int:
        return int(_mended(bodies, put_back(seen, order), sigma, freedom).sum())

    return sorted(orders, key=solves, reverse=True)


def _that_mend(
    bodies: Bodies, seen: Array, freedom: NDArray[np.int_], sigma: float, orders: list[Order]
) -> list[Order]:
    """Those that mend a frame of a few, spread over all that are left."""
    rows = np.arange(len(seen))[:: max(1, len(seen) // _FEW)]
    if not len(rows):
        return []
    return [
        order
        for order in orders
        if _mended(bodies, put_back(seen[rows], order), sigma, freedom[rows]).any()
    ]


def _mended(
    bodies: Bodies, tried: Array, sigma: float, freedom: NDArray[np.int_]
) -> NDArray[np.bool_]:
    fitted = fit(bodies, tried)
    # A marker that no fit uses any more fits nothing.
    return ~beyond(fitted, sigma) & (fitted.freedom >= freedom)
