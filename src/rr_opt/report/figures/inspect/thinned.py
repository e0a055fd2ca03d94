"""Long channels drawn with few points, without losing a peak or a gap, and drawings made small."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MOST = 800
_DIGITS = re.compile(r"(\.\d\d)\d+")
_PLACES = re.compile(r'\b(?:d|x|y)="[^"]*"')


def thinned(t: Array, y: Array, most: int = _MOST) -> tuple[Array, Array]:
    """t and y (n,) with at most about `most` points: the least and the largest of every piece.

    A piece that holds NaN gets one too, so that a gap stays one.
    """
    n = len(y)
    if n <= most:
        return t, y
    pieces = most // 2
    size = -(-n // pieces)
    rows = np.arange(n)
    padded = np.full(pieces * size, np.nan)
    padded[:n] = y
    table = padded.reshape(pieces, size)
    inside = np.isfinite(table)
    low = np.where(inside, table, np.inf).argmin(axis=1) + np.arange(pieces) * size
    high = np.where(inside, table, -np.inf).argmax(axis=1) + np.arange(pieces) * size
    holes = np.flatnonzero((~inside).any(axis=1)) * size
    first_hole = holes + (~inside[holes // size]).argmax(axis=1)
    kept = np.unique(np.concatenate([low, high, first_hole[first_hole < n]]))
    kept = kept[kept < n]
    return t[rows[kept]], y[rows[kept]]


def small(svg: str) -> str:
    """The SVG text with places to a hundredth of a point, which no screen shows."""
    return _PLACES.sub(lambda found: _DIGITS.sub(r"\1", found.group()), svg)
