"""From a point of the unit box to the best near it, one by one, where a climb stops short.

The simplex method needs no slopes: it follows ridges and the kinks where limits begin, and takes
some hundred times as long as a climb's share of a batch.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_FIRST, _RESTARTS, _GAIN = 0.05, 6, 1e-5
_WORST = 1e9


def polished(value: Callable[[Array], float], point: Array, free: list[int]) -> tuple[Array, float]:
    """The point (4,) that the simplex method leads to along the free coordinates, begun anew
    until it gains nothing, and its value."""
    from scipy.optimize import minimize  # noqa: PLC0415 - compiled code does without

    best, top = point.copy(), value(point)

    def cost(x: Array) -> float:
        there = best.copy()
        there[free] = x
        # A number, or the simplex cannot be ordered.
        return min(-value(there), _WORST)

    for _ in range(_RESTARTS if free else 0):
        corner = best[free]
        simplex = corner + np.vstack([np.zeros(len(free)), _FIRST * np.eye(len(free))])
        simplex = np.where(simplex > 1, 2 * corner - simplex, simplex)
        how = {"initial_simplex": simplex, "xatol": 1e-6, "fatol": 1e-8, "maxfev": 300}
        bounds = [(0.0, 1.0)] * len(free)
        found = minimize(cost, corner, method="Nelder-Mead", bounds=bounds, options=how)
        gain = -float(found.fun) - top
        if gain > 0:
            top += gain
            best[free] = found.x
        if gain <= _GAIN * max(abs(top), 1e-3):
            break
    return best, top
