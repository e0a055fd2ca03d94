"""How exact a steady cycle is, from what doubling its samples changes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.verify.steady import Steady

Array = NDArray[np.float64]


class Doublings:
    """What the last doublings changed of the cycles of G shapes at B periods."""

    def __init__(self, shape: tuple[int, ...]) -> None:
        self._before = np.full((3, *shape), np.nan)
        self._change = np.zeros(shape)

    def error(self, rows: NDArray[np.int_], found: Steady) -> Array:
        """Of speed and turn, and of the peak torque in hundredths, relative; inf until two cycles
        of a shape were found in a row.

        One small change may be chance, as samples fall beside or into a sudden turn of friction: so
        the change before it counts too, by the quarter that a doubling leaves at most of it.
        """
        now = np.where(np.isfinite(found.error), np.array(found[:3]), np.nan)
        scales = (
            found.scale,
            np.maximum(np.abs(found.turn), 1e-3),
            100 * found.peak_torque + 1e-10,
        )
        away = np.abs(now - self._before[:, rows]) / np.array(scales)
        change = away.max(axis=0)
        error = np.maximum(change, self._change[rows] / 4)
        self._before[:, rows] = now
        self._change[rows] = np.where(np.isfinite(change), change, 0.0)
        return np.where(np.isfinite(error), error, np.inf)
