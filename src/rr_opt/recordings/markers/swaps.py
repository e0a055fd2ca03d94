"""Corrects markers whose names the capture system exchanged, and drops misplaced single ones.

Names: two are exchanged back in the frames that do not fit; where a frame then fits, they were
swapped. A name that sits on another marker while its own is missing is found in the same way. In
frames that no pair fixes, and for which no single marker is to blame, three names in a ring and two
pairs at once are tried. Frames are independent, so a swap may last to the end of the file.

Ghosts, reflections, jumps: in a frame that still does not fit, each marker is left out in turn,
then each pair. The smallest set whose absence makes the frame fit is to blame. Where several of one
size do, all of them are left out. A frame that nothing makes fit is not taken as data.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, permutations

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.recordings.markers.rigid import Bodies, beyond, fit, marker_noise

Order = tuple[int, ...]
"""For each marker the column that holds it."""

_MOST = 12
"""Of more markers, three or four exchanged at once are not sought: there are too many ways."""


def exchanges(count: int, *sizes: int) -> Iterator[Order]:
    """Every way to exchange 2 of `count` markers, 3 in a ring, or 4 as two pairs at once."""
    for size in sizes if max(sizes) == 2 or count <= _MOST else ():
        for chosen in combinations(range(count), size):
            for places in permutations(chosen):
                way = dict(zip(chosen, places, strict=True))
                if all(i != j and (size == 3 or way[j] == i) for i, j in way.items()):
                    yield tuple(way.get(i, i) for i in range(count))


def members(order: Order) -> tuple[int, ...]:
    """The markers that are not in their own column."""
    return tuple(i for i, column in enumerate(order) if i != column)


_AS_GOOD = 20.0
"""Difference in the sum of squares, over the variance, needed to distinguish two sets."""


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
"""Factor by which an exchange must reduce the noise of a whole recording to be accepted."""
_ROUGH = 2e-3
"""Noise beyond which markers must be exchanged, or wrong in the layout, m."""


@dataclass(frozen=True)
class Swap:
    """Columns of the bodies whose names were exchanged, and the frames (m,) where they were."""

    members: tuple[int, ...]
    frames: NDArray[np.int_]


def swapped_throughout(bodies: Bodies, seen: Array) -> Order | None:
    """An exchange that lasts for most of the recording, or is in the layout."""
    rows = np.flatnonzero(np.isfinite(seen[..., 0]).sum(axis=1) > 3)
    sample = seen[rows[:: max(1, len(rows) // _SAMPLE)]]
    if not len(sample):
        return None
    own, count = marker_noise(fit(bodies, sample)), len(bodies.labels)
    found = _quietest(bodies, sample, exchanges(count, 2), own)
    if found is None and own > _ROUGH:
        few = sample[:: max(1, len(sample) // _FEW)]
        found = _quietest(bodies, few, exchanges(count, 3, 4), own)
    return found


def _quietest(bodies: Bodies, seen: Array, orders: Iterator[Order], own: float) -> Order | None:
    tried = {order: marker_noise(fit(bodies, seen[:, order])) for order in orders}
    tried = {order: sigma for order, sigma in tried.items() if np.isfinite(sigma)}
    best = min(tried, key=lambda order: tried[order], default=None)
    return best if best and tried[best] * _BETTER < own else None


def put_right(bodies: Bodies, seen: Array, sigma: float) -> tuple[Array, list[Swap]]:
    """The markers (n, k, 2) with the names corrected, and what was exchanged.

    sigma: of a marker's coordinate, m.
    """
    first, count = fit(bodies, seen), len(bodies.labels)
    seen, found = seen.copy(), list[Swap]()

    def mended(rows: NDArray[np.int_], order: Order) -> NDArray[np.bool_]:
        fitted = fit(bodies, seen[rows][:, order])
        # A marker that no fit uses any more fits nothing.
        return ~beyond(fitted, sigma) & (fitted.freedom >= first.freedom[rows])

    def exchanged(
        left: NDArray[np.int_], orders: Iterator[Order], sample: int, least: int
    ) -> NDArray[np.int_]:
        """The frames still unexplained after trying orders, in the order of how many frames of a
        sample they fix; least: how many of it they have to fix."""
        rows = left[:: max(1, len(left) // sample)]
        mends = {order: int(mended(rows, order).sum()) for order in orders} if len(rows) else {}
        for order in sorted(mends, key=lambda one: -mends[one]):
            if mends[order] >= least and len(left):
                solved = mended(left, order)
                if solved.any():
                    rows, left = left[solved], left[~solved]
                    seen[rows] = seen[rows][:, order]
                    found.append(Swap(members(order), rows))
        return left

    left = np.flatnonzero(beyond(first, sigma))
    left = exchanged(left, exchanges(count, 2), _SAMPLE, 0)
    if len(left):
        left = left[without_ghosts(bodies, seen[left], sigma, most=1).lost]
        exchanged(left, exchanges(count, 3, 4), _FEW, 1)
    return seen, found
