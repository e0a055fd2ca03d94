"""What is known of steady cycles, however they were found."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_Where = NDArray[np.int_] | tuple[NDArray[np.int_], NDArray[np.int_]]


class Steady(NamedTuple):
    """Steady cycles of G shapes at B periods; every array (G, B).

    speed        along the mean circle, signed along platform 1's mean heading, m/s
    turn         heading gained per period, rad
    peak_torque  largest |torque|, between the samples too, N m
    error        size of the fastest harmonics of the velocity, relative to the speed; inf where
                 no steady cycle was found
    scale        what an error of the speed is relative to, m/s
    """

    speed: Array
    turn: Array
    peak_torque: Array
    error: Array
    scale: Array


class Speeds(NamedTuple):
    """Arrays of one shape; NaN where not converged.

    speed        signed, m/s
    turn         heading gained per period, rad
    peak_torque  N m
    converged    a steady cycle was found and is resolved
    """

    speed: Array
    turn: Array
    peak_torque: Array
    converged: NDArray[np.bool_]

    def keep(self, where: _Where, found: Steady, good: NDArray[np.bool_]) -> None:
        """Write the good ones of what was found to these places, and NaN to the others."""
        self.converged[where] = good
        for own, values in zip(self[:3], found[:3], strict=True):
            own[where] = np.where(good, values, np.nan)
