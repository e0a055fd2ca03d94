"""Angles that jump by a turn because somebody kept them within one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def unwrapped(angle: Array) -> Array:
    """The angle (n,), rad, without jumps of a turn; what is missing stays missing."""
    known = np.isfinite(angle)
    whole = np.full(len(angle), np.nan)
    whole[known] = np.unwrap(angle[known])
    return whole


def turns_taken(angle: Array) -> int:
    """How often the angle (n,), rad, jumps by a turn from one sample to the next."""
    known = angle[np.isfinite(angle)]
    return int((np.abs(np.diff(np.unwrap(known) - known)) > np.pi).sum()) if len(known) else 0
