"""What the compiled loops read besides the points: sines, and the matrices of `spectral`."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rr_opt.verify.spectral import matrices

Array = NDArray[np.float64]


@lru_cache
def sines(most: int, straight: bool) -> Array:
    """Of the phases of `most` samples, and as many more as their cosines need."""
    extra = most // (2 if straight else 4)
    return np.sin(np.arange(most + extra) * ((1 if straight else 2) * math.pi / most))


@lru_cache
def table(n: int, straight: bool) -> tuple[Array, tuple[int, int, int]]:
    """The `Table` of data/sweep_viscous.c, and the rows of its last three matrices."""
    theta = np.arange(n) * ((1 if straight else 2) * math.pi / n)
    integral, tail, _ = matrices(n, False)
    turning, side_tail, dense = matrices(n, straight)
    phase = 2 * math.pi / n * np.outer(np.arange(n // 2 + 1), np.arange(n))
    forward = np.concatenate([np.cos(phase), -np.sin(phase[1:-1])])
    share = np.full(n, 2.0 / n)
    share[[0, n // 2]] = 1.0 / n
    parts = (
        *(np.sin(theta), np.cos(theta), integral, turning, forward, forward.T * share),
        *(tail, side_tail, dense),
    )
    sizes = len(tail), len(side_tail), len(dense)
    return np.concatenate([part.ravel() for part in parts]), sizes
