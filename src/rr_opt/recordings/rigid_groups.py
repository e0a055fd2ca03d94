"""Which markers are on one rigid body: those whose distances do not change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from rr_opt.outcome import InputError

Array = NDArray[np.float64]

_APART = 6.0
"""How many times more a distance between platforms must change than one within a platform."""


def rigid_groups(labels: Sequence[str], seen: Array) -> tuple[list[int], list[int], list[int]]:
    """Two sets of markers with fixed distances, the larger first, and those in neither.

    seen: (n, k, 2), m. Raises InputError if there are no two such sets.
    """
    if len(labels) < 4:
        _refuse(labels, "fewer than two markers for each platform")
    apart = np.linalg.norm(seen[:, :, None] - seen[:, None], axis=-1)
    known = np.isfinite(apart).any(axis=0)
    apart = np.where(known, apart, 0.0)
    middle = np.nanmedian(apart, axis=0)
    change = 1.4826 * np.nanmedian(np.abs(apart - middle), axis=0)
    # Two markers that are never seen together are not known to be on one platform.
    change[~known] = 10 * change[known].max(initial=1.0)
    np.fill_diagonal(change, 0.0)
    tree = linkage(squareform((change + change.T) / 2, checks=False), "complete")
    # Cut where the next merger would join what moves: the largest step in the tree's heights.
    heights = np.maximum(tree[:, 2], 1e-6)
    cut = int(np.argmax(heights[1:] / heights[:-1])) if len(heights) > 1 else 0
    if heights[cut + 1] < _APART * heights[cut]:
        _refuse(labels, "no two sets of markers that move against each other")
    member = fcluster(tree, t=heights[cut] * 1.001, criterion="distance")
    sets = sorted(
        ([int(i) for i in np.flatnonzero(member == one)] for one in set(member)),
        key=len, reverse=True,
    )  # fmt: skip
    if len(sets) < 2 or len(sets[1]) < 2:
        _refuse(labels, "only one set of markers with fixed distances")
    if len(sets) > 2 and len(sets[2]) >= 2:
        _refuse(labels, "more than two sets of markers with fixed distances")
    return sets[0], sets[1], [i for one in sets[2:] for i in one]


def _refuse(labels: Sequence[str], what: str) -> NoReturn:
    raise InputError(
        f"The markers {', '.join(labels)} show {what}. Expected two rigid platforms with at least "
        "two markers each, and a servo that wiggles. Give the layout with --layout."
    )
