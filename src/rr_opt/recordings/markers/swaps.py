"""Markers whose names the capture system exchanged, put right, and single ones that are elsewhere.

Names: two are exchanged back in the frames that do not fit; where a frame then fits, they were
swapped. A name that sits on another marker while its own is missing is found in the same way. In
frames that no pair mends, and no single marker is to blame for, three names in a ring and two pairs
at once are tried. Nothing depends on the frames before, so a swap may last to the end of the file.

Ghosts, reflections, jumps: in a frame that still does not fit, each marker is left out in turn,
then each pair. The smallest set whose absence makes the frame fit is to blame. Where several of one
size do, all of them are left out. A frame that nothing makes fit is not taken as data.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.recordings.markers.layout import Bodies
from rr_opt.recordings.markers.rigid import beyond, fit, marker_noise

Order = tuple[int, ...]
"""For each marker the column that it is in; in its own place otherwise."""

_MOST = 12
"""Of more markers, three or four exchanged at once are not sought: there are too many ways."""


def pairs(count: int) -> list[Order]:
    """Two of `count` markers exchanged."""
    return [_moved(count, {i: j, j: i}) for i, j in combinations(range(count), 2)]


def several(count: int) -> list[Order]:
    """Three in a ring, or two pairs at once."""
    if count > _MOST:
        return []
    rings = [
        _moved(count, way)
        for i, j, k in combinations(range(count), 3)
        for way in ({i: j, j: k, k: i}, {i: k, k: j, j: i})
    ]
    doubles = [
        _moved(count, {a: b, b: a, c: d, d: c})
        for i, j, k, m in combinations(range(count), 4)
        for a, b, c, d in ((i, j, k, m), (i, k, j, m), (i, m, j, k))
    ]
    return rings + doubles


def members(order: Order) -> tuple[int, ...]:
    """The markers that are not in their own column."""
    return tuple(i for i, column in enumerate(order) if i != column)


def put_back(seen: NDArray[np.float64], order: Order) -> NDArray[np.float64]:
    """The markers (n, k, 2) each in its own column."""
    return seen[:, order]


def _moved(count: int, way: dict[int, int]) -> Order:
    return tuple(way.get(i, i) for i in range(count))


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
