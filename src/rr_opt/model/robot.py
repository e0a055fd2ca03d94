"""The robot as frozen data: two platforms on wheel pairs, joined by a servo at P.

Symbols are the paper's (section 2, Fig. 1 and Table 1). Everything is SI.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType


@dataclass(frozen=True)
class Platform:
    """One platform with its wheel pair.

    m      mass, kg
    I      moment of inertia about the vertical through the centre of mass, kg m2
    c      distance from the axle's centre C to the joint P, m
    a      distance from C to the centre of mass, towards P, m
    b      half track: distance from C to each wheel, m
    kappa  viscous friction of one wheel about its axle, N m s
    """

    m: float
    I: float
    c: float
    a: float
    b: float
    kappa: float

    @property
    def joint_to_centre(self) -> float:
        """Distance from the joint P to the centre of mass, c - a, m (Table 1)."""
        return self.c - self.a

    @property
    def joint_inertia(self) -> float:
        """Moment of inertia about P by the parallel-axis theorem, kg m2."""
        # Products overflow to infinity, which is then told of; powers raise.
        reach = self.joint_to_centre
        return self.I + self.m * (reach * reach)


@dataclass(frozen=True)
class Servo:
    """What the servo can do: |phi| (rad), |dphi/dt| (rad/s), |torque| (N m)."""

    angle_limit: float = 2.6
    rate_limit: float = math.pi
    torque_limit: float = 1.37


@dataclass(frozen=True)
class EffectUse:
    """An effect of the catalogue by name, with the values of its parameters in SI."""

    name: str
    values: Mapping[str, float]


@dataclass(frozen=True)
class Robot:
    """A Roller Racer. `physics` lists effects beyond the paper's model.

    `provenance` maps a key path such as `platform1.m` to a sentence that begins with
    measured, fitted or assumed.
    """

    platform1: Platform
    platform2: Platform
    h: float
    servo: Servo = field(default_factory=Servo)
    physics: tuple[EffectUse, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    name: str = ""

    @property
    def k1(self) -> float:
        """Viscous friction per wheel of platform 1 along the floor, kappa1/h^2, N s/m."""
        return self.platform1.kappa / (self.h * self.h)

    @property
    def k2(self) -> float:
        """Viscous friction per wheel of platform 2 along the floor, kappa2/h^2, N s/m."""
        return self.platform2.kappa / (self.h * self.h)

    @property
    def singular_angle(self) -> float:
        """The smallest |phi| at which S1 = c1 cos phi + c2 vanishes, rad; inf if never."""
        ratio = self.platform2.c / self.platform1.c
        return math.acos(-ratio) if ratio <= 1.0 else math.inf
