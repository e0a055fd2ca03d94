"""A recording: where the robot was seen to be, when, and how well."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntFlag
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CHANNELS = ("x", "y", "psi", "phi")
"""What every recording has, in this order; `torque` may come beside them."""


class Flag(IntFlag):
    """Why a value is not taken as data; 0 is a good one."""

    MISSING = 1
    OUTLIER = 2
    OUT_OF_ORDER = 8


@dataclass(frozen=True)
class Recording:
    """One run, sampled at the times t (n,) of the command's clock, s.

    values  by channel (n,): x, y the joint P, m; psi the heading of platform 1 and phi the angle of
            platform 2's axis against platform 1's, unwrapped, rad; torque of the servo, N m, if it
            was recorded. A value that is flagged stays as it was read; where there was none, NaN
    sigma   by channel (n,), the noise's standard deviation, same units; may differ by sample; NaN
            where nobody said
    flags   by channel (n,), `Flag`
    source  where it came from: file, format, rate, clock, what was done to it; plain text by name
    doubts  sentences on what looked wrong in it and what was made of it
    """

    name: str
    t: Array
    values: Mapping[str, Array]
    sigma: Mapping[str, Array]
    flags: Mapping[str, NDArray[np.uint8]]
    source: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    doubts: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.t)

    @property
    def channels(self) -> tuple[str, ...]:
        """The channels that it has."""
        return tuple(self.values)

    def data(self, channel: str) -> Array:
        """The values (n,) of a channel that are taken as data; NaN elsewhere."""
        return np.where(self.flags[channel] == 0, self.values[channel], np.nan)
