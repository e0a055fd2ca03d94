"""How many steps or nodes a period each point needs: the fewest that are close enough.

Found beforehand and not counted, which favours whoever takes fixed steps.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchmarks.sweep.case import ACCURACY, LEAST_SPEED, Array, Work
from benchmarks.sweep.ways import NODES, NUMBA

_LEAST, _MOST = {"rk4": 32, "nodes": 16}, {"rk4": 16384, "nodes": 1024}


def needed(kind: str, work: Work, true: Array) -> NDArray[np.int_]:
    """(K,) powers of two; with fewer than twice as many, the error may be small by chance."""
    finder = NUMBA if kind == "rk4" else NODES
    found = np.zeros(work.size, int)
    pending = np.arange(work.size)
    n = _LEAST[kind]
    before = np.zeros(work.size, bool)
    while len(pending):
        speed = finder.run(work.only(pending), n)
        good = np.abs(speed - true[pending]) <= ACCURACY * np.maximum(true[pending], LEAST_SPEED)
        settled = good & before[pending] | (n >= _MOST[kind])
        found[pending[settled]] = n // 2
        before[pending] = good
        pending, n = pending[~settled], 2 * n
    return found
