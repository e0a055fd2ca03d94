"""Parts of a floor, round or with a straight edge: those that a map says would gain most."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from rr_opt.diagnose.floor_map import Depth, FloorMap
from rr_opt.diagnose.model import Array

_PLACES = 12
"""Across the floor where wheels were, on which circles are tried."""

_RADII = (0.06, 0.1, 0.15, 0.22, 0.32, 0.45)
"""Of that floor's longer side."""

_DIRECTIONS, _BORDERS = 36, 36

_SEEDS, _BEST = 5, 2
"""So many unlike ones are moved to where they gain most, and so many of those are proposed."""

_ALIKE = 0.9
"""The cosine between two that cover about the same."""

_MOVES = 80


@dataclass(frozen=True)
class Shape:
    """A kind of patch, of which each one is a few numbers.

    depth   how deep inside one places are, m
    grid    those to try for wheels that were at (2, n), (shapes, numbers)
    values  one's values as a robot file has them, m and rad, around the middle (2,) of the floor
    """

    depth: Callable[[Array], Depth]
    grid: Callable[[Array], Array]
    values: Callable[[Array, Array], Mapping[str, float]]


def likely(floor: FloorMap, shape: Shape) -> list[tuple[float, Mapping[str, float]]]:
    """The gains of those of a shape that gain most, unlike one another, and their values."""
    places = floor.places.reshape(2, -1)
    grid = shape.grid(places)
    if not len(grid):
        return []
    shares = np.array([floor.roughly(shape.depth(one)) for one in grid])
    best = np.argsort(-floor.gains(shares)[0])
    size = float(np.ptp(places, axis=1).max()) / _PLACES
    moved = [_moved(floor, shape, grid[k], size) for k in _unlike(shares, best, _SEEDS)]
    shares = np.array([floor.at(shape.depth(one)) for one in moved])
    gains, multipliers = floor.gains(shares)
    middle = places.mean(axis=1)
    return [
        (float(gains[k]), {"multiplier": float(multipliers[k]), **shape.values(moved[k], middle)})
        for k in _unlike(shares, np.argsort(-gains), _BEST)
    ]


def _unlike(shares: Array, order: NDArray[np.intp], most: int) -> list[int]:
    """The first few in order, none much like one before it."""
    found: list[int] = []
    length = np.linalg.norm(shares, axis=1)
    for k in order:
        alike = (shares[found] @ shares[k]) > _ALIKE * length[found] * length[k]
        if length[k] > 0 and not alike.any():
            found.append(int(k))
        if len(found) == most:
            break
    return found


def _moved(floor: FloorMap, shape: Shape, one: Array, size: float) -> Array:
    """Where one gains most near by."""
    around = np.vstack([one, one + size / 2 * np.eye(one.size)])
    best = minimize(
        lambda at: -float(floor.gains(floor.at(shape.depth(at))[None])[0][0]),
        one,
        method="Nelder-Mead",
        options={"maxfev": _MOVES, "initial_simplex": around},
    )
    return np.asarray(best.x)


def _circles(places: Array) -> Array:
    low, high = places.min(axis=1), places.max(axis=1)
    size = float((high - low).max())
    step = size / _PLACES
    if step == 0:
        return np.zeros((0, 3))
    x, y = (np.arange(a - step, b + 2 * step, step) for a, b in zip(low, high, strict=True))
    return np.array([(*at, size * r) for *at, r in itertools.product(x, y, _RADII)])


def _edges(places: Array) -> Array:
    out = []
    for normal in 2 * math.pi * np.arange(_DIRECTIONS) / _DIRECTIONS - math.pi:
        along = np.array([math.cos(normal), math.sin(normal)]) @ places
        borders = np.linspace(along.min(), along.max(), _BORDERS + 2)[1:-1]
        out += [(normal, border) for border in borders]
    return np.array(out)


def _edge_values(of: Array, middle: Array) -> Mapping[str, float]:
    """Through the point of the edge that is nearest to the middle."""
    normal = np.array([math.cos(of[0]), math.sin(of[0])])
    x, y = middle + (of[1] - middle @ normal) * normal
    return {
        "normal": float(math.remainder(of[0], 2 * math.pi)),
        "edge_x": float(x),
        "edge_y": float(y),
    }


ROUND = Shape(
    depth=lambda of: lambda x, y: of[2] - np.hypot(x - of[0], y - of[1]),
    grid=_circles,
    values=lambda of, _: {"x": float(of[0]), "y": float(of[1]), "radius": float(of[2])},
)

STRAIGHT = Shape(
    depth=lambda of: lambda x, y: x * math.cos(of[0]) + y * math.sin(of[0]) - of[1],
    grid=_edges,
    values=_edge_values,
)
