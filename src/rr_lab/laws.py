"""Laws of the wheels' friction that changes with place, time, speed, turn or load.

An engine that steps through a motion calls them at each step; another one makes expressions of
their data.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_lab.rig import Wheels


@dataclass(frozen=True)
class Circle:
    """A round place, m."""

    x: float
    y: float
    radius: float

    def depth(self, x: Any, y: Any) -> Any:
        """How far inside a point is, m; negative outside. Of numbers or expressions."""
        return self.radius - ((x - self.x) ** 2 + (y - self.y) ** 2) ** 0.5


@dataclass(frozen=True)
class Edge:
    """All that lies beyond a straight edge through (x, y), m; normal, rad, points into it."""

    x: float
    y: float
    normal: float

    def depth(self, x: Any, y: Any) -> Any:
        """How far beyond a point is, m; negative before it. Of numbers or expressions."""
        return (x - self.x) * math.cos(self.normal) + (y - self.y) * math.sin(self.normal)


@dataclass(frozen=True)
class Patch:
    """Friction `times` as large for each wheel that is within."""

    times: float
    within: Circle | Edge

    def __call__(self, wheels: Wheels) -> None:
        """The friction of this instant."""
        # Plain numbers: a law is asked at every step, and tables of four cost more than they do.
        for wheel, place in enumerate(wheels.places.tolist()):
            if self.within.depth(*place) > 0:
                wheels.damping[wheel] *= self.times
                wheels.dry[wheel] *= self.times


@dataclass(frozen=True)
class Falling:
    """Dry friction of all wheels that falls from `torque` (N m) to a third of it as they turn
    faster than `rate` (rad/s)."""

    torque: float
    rate: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction of this instant."""
        wheels.dry += self.torque * (1 + 2 * np.exp(-((wheels.rate / self.rate) ** 2))) / 3


@dataclass(frozen=True)
class Drift:
    """Viscous friction that changes by the fraction `change` with the time constant `time` (s)."""

    change: float
    time: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction of this instant."""
        wheels.damping *= 1 + self.change * (1 - np.exp(-max(wheels.t, 0.0) / self.time))


@dataclass(frozen=True)
class Rub:
    """The left wheel of platform 1 rubs with `torque` (N m) over the first fifth of each turn."""

    torque: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction of this instant."""
        if wheels.angle[0] % (2 * np.pi) < 0.4 * np.pi:
            wheels.dry[0] += self.torque


@dataclass(frozen=True)
class RollingResistance:
    """Dry friction at the rim of each wheel, `mu` of its load."""

    mu: float
    h: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction of this instant."""
        wheels.dry += self.mu * self.h * wheels.loads
