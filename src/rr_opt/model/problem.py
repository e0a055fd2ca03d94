"""A gait problem as frozen data: which gaits are allowed on which robot, and what is wanted."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from rr_opt.model.ballast import About, By, Loads
from rr_opt.model.robot import Robot

Direction = Literal["forward", "backward", "either"]
Shape = Literal["sine", "fourier", "free"]


@dataclass(frozen=True)
class Interval:
    """A closed interval; `low == high` fixes the quantity."""

    low: float
    high: float

    @property
    def fixed(self) -> bool:
        """Both ends are one."""
        return self.low == self.high

    def clip(self, value: float) -> float:
        """The number of the interval that is nearest to value."""
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class GaitBounds:
    """Where amplitude (rad), period (s) and offset (rad) of the gait may lie, and its shape.

    A gait that is no sine has the mean angle `offset`, its first harmonic has at least the least
    amplitude, and phi never leaves the offset by more than the largest. So every sine within the
    bounds is a gait of the other shapes within the bounds too.

    harmonics  of a `fourier` gait
    intervals  of a `free` gait, on each of which the servo's acceleration is constant
    """

    amplitude: Interval = Interval(0.05, 2.6)
    period: Interval = Interval(0.3, 3.0)
    offset: Interval = Interval(0.0, 0.0)
    shape: Shape = "sine"
    harmonics: int = 3
    intervals: int = 96


@dataclass(frozen=True)
class RatioChoice:
    """J20/J10 as a decision: its bounds, its definition and its realisation."""

    bounds: Interval
    about: About = "joint"
    by: By = "inertia"
    loads: Loads = field(default_factory=Loads)


LARGEST_EXCESS = 1e-4
"""By so much, relative to it, a gait may go over a limit and still counts as keeping it."""


@dataclass(frozen=True)
class Limits:
    """|phi| <= angle (rad), |dphi/dt| <= rate (rad/s), |torque| <= torque (N m),
    S1 = c1 cos phi + c2 >= singularity (m)."""

    angle: float
    rate: float
    torque: float
    singularity: float = 0.020

    def worst(self, reached: Mapping[str, float]) -> tuple[str, float]:
        """The limit that is broken most, or kept most narrowly, and its excess relative to it.

        reached: the extreme of what each limit bounds, by the limit's name, SI.
        """
        limits = {name: getattr(self, name) for name in reached}
        excess = {
            name: (limit - reached[name] if name == "singularity" else reached[name] - limit)
            / abs(limit)
            for name, limit in limits.items()
            if math.isfinite(limit)
        }
        name = max(excess, key=lambda one: excess[one])
        return name, excess[name]


ANY = Interval(-math.inf, math.inf)


@dataclass(frozen=True)
class Turn:
    """Which circles a gait may go round; what is not asked may be anything.

    Positive is to the left (counter-clockwise, seen from above), wherever the robot goes.

    curvature  heading gained per metre along the mean circle, 1/m
    yaw_rate   heading gained per second, rad/s
    heading    heading gained per period, rad
    """

    curvature: Interval = ANY
    yaw_rate: Interval = ANY
    heading: Interval = ANY


@dataclass(frozen=True)
class Problem:
    """Which gait drives `robot` fastest within `gait`, `inertia_ratio`, `limits` and `turn`?

    `inertia_ratio` None: the robot as it is; `turn` None: straight or on any circle.
    """

    robot: Robot
    limits: Limits
    gait: GaitBounds = field(default_factory=GaitBounds)
    inertia_ratio: RatioChoice | None = None
    direction: Direction = "either"
    turn: Turn | None = None
