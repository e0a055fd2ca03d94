"""A gait problem as frozen data: which gaits are allowed on which robot, and what is wanted."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from rr_opt.robot.ballast import About, By, Loads
from rr_opt.robot.parameters import Robot

Direction = Literal["forward", "backward", "either"]


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
    """Where amplitude (rad), period (s) and offset (rad) of the gait may lie."""

    amplitude: Interval = Interval(0.05, 2.6)
    period: Interval = Interval(0.3, 3.0)
    offset: Interval = Interval(0.0, 0.0)
    shape: Literal["sine"] = "sine"


@dataclass(frozen=True)
class RatioChoice:
    """J20/J10 as a decision: its bounds, its definition and its realisation."""

    bounds: Interval
    about: About = "joint"
    by: By = "inertia"
    loads: Loads = field(default_factory=Loads)


@dataclass(frozen=True)
class Limits:
    """|phi| <= angle (rad), |dphi/dt| <= rate (rad/s), |torque| <= torque (N m),
    S1 = c1 cos phi + c2 >= singularity (m)."""

    angle: float
    rate: float
    torque: float
    singularity: float = 0.020


@dataclass(frozen=True)
class Problem:
    """Which gait drives `robot` fastest within `gait`, `inertia_ratio` and `limits`?

    `inertia_ratio` None: the robot as it is.
    """

    robot: Robot
    limits: Limits
    gait: GaitBounds = field(default_factory=GaitBounds)
    inertia_ratio: RatioChoice | None = None
    direction: Direction = "either"
