"""Which marker sits where on the robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Layout:
    """The markers of both platforms, by name as in the marker file, m.

    platform1, platform2  a marker's place (forward, left) or (forward, left, up) in its platform's
        own axes. Both have their origin at the joint P, and `left` is +90 degrees from `forward`.
        Platform 1's forward axis is the one whose heading is psi: from P TOWARDS its axle.
        Platform 2's is the one that psi + phi turns to: from its axle towards P, so a marker over
        axle 2 stands at (-c2, 0)
    up  the capture frame's axis that points up from the floor: `x`, `y` or `z`, or its opposite.
        x and y of the recording are then the two others in cyclic order
    """

    platform1: Mapping[str, tuple[float, ...]]
    platform2: Mapping[str, tuple[float, ...]]
    up: str = "z"
