"""Where on the floor the wheels roll harder, or more easily: places to look for a patch.

The floor is cut into cells, each with a share of drag of its own, all zero; one linearised pass
says what each would change. Every circle and every half of the floor is a sum of cells, so what it
would gain, parameters and starts re-fitted, is a matter of adding up.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.observed import Along
from rr_opt.diagnose.pushed_motion import PUSHES

_ACROSS = 10
"""Cells across the longer side of the visited floor."""

_SMALLEST = 0.12
"""Side of a cell, m, at least: the wheels of a robot are some 10 cm apart."""

_LEAST, _MOST = 0.1, 30.0
_DIRECTIONS = 16
_BEST = 2


@dataclass(frozen=True)
class Cells:
    """Cells of the floor: their centres (n, 2) and their side, m."""

    centres: Array
    side: float


def cells_of(paths: Sequence[Array]) -> Cells:
    """Cells where the robot was, from the paths (n, 2) of its joint."""
    every = np.vstack(paths)
    every = every[np.isfinite(every).all(axis=1)]
    side = max(float(np.ptp(every, axis=0).max()) / _ACROSS, _SMALLEST)
    visited = np.unique(np.round(every / side).astype(int), axis=0)
    return Cells(visited * side, side)


def drags(cells: Cells, along: Along, k: Array) -> Array:
    """Pushes (cells, 7, n) by drag of each cell, as much of it as all the floor has.

    k  of the wheels (4,), N s/m

    Places and speeds are those recorded: with them the drag is right however strong it is, where
    predicted ones would have the robot drive on.
    """
    apart = np.abs(along.places - cells.centres[:, None, :, None]) / cells.side
    near = np.maximum(0.0, 1.0 - apart).prod(axis=2)
    out = np.zeros((len(near), len(PUSHES), along.t.size))
    out[:, :4] = -k[:, None] * near * along.u
    return out


Found = tuple[float, Mapping[str, float]]
"""What a patch would gain, and its values."""


def likely(cells: Cells, g: Array, H: Array) -> tuple[list[Found], list[Found]]:
    """The circles and the edges that gain most.

    g (n,), H (n, n): of the cost by the shares, everything else re-fitted.
    """
    x, y = cells.centres.T
    circles, edges = [], []
    for (cx, cy), size in itertools.product(cells.centres, (0.8, 1.3, 2.0)):
        radius = size * cells.side
        inside = (np.hypot(x - cx, y - cy) <= radius).astype(float)
        gain, share = _gain(inside, g, H)
        circles.append((gain, {"multiplier": share, "x": cx, "y": cy, "radius": radius}))
    for k in range(_DIRECTIONS):
        normal = 2 * math.pi * k / _DIRECTIONS - math.pi
        along = x * math.cos(normal) + y * math.sin(normal)
        for border in np.unique(np.round(along / cells.side))[1:] - 0.5:
            depth = border * cells.side
            gain, share = _gain((along > depth).astype(float), g, H)
            edge = {"edge_x": depth * math.cos(normal), "edge_y": depth * math.sin(normal)}
            edges.append((gain, {"multiplier": share, "normal": normal, **edge}))
    return _top(circles), _top(edges)


def _gain(inside: Array, g: Array, H: Array) -> tuple[float, float]:
    """What a patch gains with the multiplier that is best for it, and that: none is below zero."""
    slope, bend = float(inside @ g), float(inside @ H @ inside)
    if bend <= 0:
        return 0.0, 1.0
    share = min(max(-slope / bend, _LEAST - 1.0), _MOST - 1.0)
    return -share * (2 * slope + bend * share), 1.0 + share


def _top(found: list[Found]) -> list[Found]:
    return sorted(found, key=lambda one: -one[0])[:_BEST]
