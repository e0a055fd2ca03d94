"""Work over many points, a piece at a time, on all processors that this process may use."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def in_pieces(work: Callable[[slice], Array], count: int, piece: int) -> Array:
    """work(points) -> (rows, points) of all `count` >= 1 points, side by side.

    The work has to let other threads run, as what ctypes calls does.
    """
    parts = [slice(k, min(k + piece, count)) for k in range(0, count, piece)]
    workers = min(_processors(), len(parts))
    if workers < 2:
        return np.concatenate([work(part) for part in parts], axis=1)
    with ThreadPoolExecutor(workers) as pool:
        return np.concatenate(list(pool.map(work, parts)), axis=1)


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
