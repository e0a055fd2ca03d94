"""The circle of a gait: its centre, its curvature, and how long once round takes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.motion.cycle import Cycle
from rr_opt.outcome import InputError

STRAIGHT = 1e-12
"""Heading per period, rad, up to which it is rounding and the gait straight."""

_STILL = 1e-12  # m/s


@dataclass(frozen=True)
class Circle:
    """Positive is to the left, whichever way the robot drives.

    speed      along the mean circle, m/s, positive along platform 1
    curvature  heading per metre of the mean circle, 1/m
    heading    per period, rad
    period     s
    centre     in platform 1's axes at phase 0 with P at the origin, m; None for a straight gait
    """

    speed: float
    curvature: float
    heading: float
    period: float
    centre: tuple[float, float] | None

    @property
    def straight(self) -> bool:
        """It turns by no more than STRAIGHT a period."""
        return self.centre is None

    @property
    def radius(self) -> float:
        """m, positive; inf for a straight gait."""
        return math.inf if self.straight else abs(1 / self.curvature)

    @property
    def yaw_rate(self) -> float:
        """Heading per second, rad/s."""
        return self.heading / self.period

    @property
    def periods_round(self) -> float:
        """Periods that a full turn takes; inf for a straight gait."""
        return math.inf if self.straight else abs(2 * math.pi / self.heading)

    @property
    def time_round(self) -> float:
        """Time that a full turn takes, s; inf for a straight gait."""
        return self.periods_round * self.period


def circle_of(cycle: Cycle) -> Circle:
    """The circle that repeating a cycle makes. Raises InputError if the robot stands still."""
    if abs(cycle.speed) <= _STILL:
        raise InputError(
            f"The gait moves the robot at {cycle.speed:.1e} m/s. Expected a gait that moves it: "
            "one that stands still has no circle. Give an amplitude above 0."
        )
    straight = abs(cycle.dpsi) <= STRAIGHT
    return Circle(
        speed=cycle.speed,
        # Finite and right however straight: only the centre runs off.
        curvature=cycle.dpsi / (cycle.period * abs(cycle.speed)),
        heading=cycle.dpsi,
        period=cycle.period,
        centre=None if straight else _centre(cycle),
    )


def _centre(cycle: Cycle) -> tuple[float, float]:
    """C = (dx, dy) + Rot(dpsi) C, solved."""
    half = cycle.dpsi / 2
    c = complex(cycle.dx, cycle.dy) * 1j * np.exp(-1j * half) / (2 * math.sin(half))
    return float(c.real), float(c.imag)
