"""What a servo's log holds: where the servo was told to be, and where it said it was."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ServoLog:
    """A servo's log of n rows, on the servo's own clock.

    name            of the file
    t               (n,), s, increasing, on the servo's clock, which is not the capture's
    goal, present   (n,), counts as in the file, NaN where empty; None: the file has no such column
    goal_angle      (n,), rad, phi as commanded: (goal - zero) times the angle of a count; or None
    present_angle   (n,), rad, phi as the servo's own encoder had it; or None
    resolution      the angle of one count, rad
    rate            rows per second, Hz, as the times have it
    source          where it came from, plain text by name
    doubts          sentences on what looked wrong and what was made of it
    """

    name: str
    t: Array
    goal: Array | None
    present: Array | None
    goal_angle: Array | None
    present_angle: Array | None
    resolution: float
    rate: float
    source: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    doubts: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.t)
