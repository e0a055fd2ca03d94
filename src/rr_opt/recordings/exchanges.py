"""The ways in which markers may have each other's names."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

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
