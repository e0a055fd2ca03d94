"""The robot as frozen data: two platforms on wheel pairs, joined by a servo at P.

Symbols are the paper's (section 2, Fig. 1 and Table 1). Everything is SI.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.model.fields import SI, data, declared
from rr_opt.model.parameters import SYMBOLS
from rr_opt.units import Number


def _parameter(symbol: str) -> Any:
    one = SYMBOLS[symbol]
    return declared(one.quantity, one.description)


@data
class Platform:
    """One platform with its wheel pair.

    m      mass, kg
    I      moment of inertia about the vertical through the centre of mass, kg m2
    c      distance from the axle's centre C to the joint P, m
    a      distance from C to the centre of mass, towards P, m
    b      half track: distance from C to each wheel, m
    kappa  viscous friction of one wheel about its axle, N m s
    """

    m: SI = _parameter("m")
    I: SI = _parameter("I")
    c: SI = _parameter("c")
    a: SI = _parameter("a")
    b: SI = _parameter("b")
    kappa: SI = _parameter("kappa")

    @property
    def joint_to_centre(self) -> float:
        """Distance from the joint P to the centre of mass, c - a, m (Table 1)."""
        return self.c - self.a

    @property
    def joint_inertia(self) -> float:
        """Moment of inertia about P by the parallel-axis theorem, kg m2."""
        # A product overflows to infinity, which a check then reports; a power raises.
        reach = self.joint_to_centre
        return self.I + self.m * (reach * reach)


ANGLE_LIMIT = Number("rad", "2.6", above=0, below=math.pi)
RATE_LIMIT = Number("rad/s", "30 rpm", above=0, endless=True)
TORQUE_LIMIT = Number("N m", "14 kgf*cm", above=0, endless=True)


@data
class Servo:
    """What the servo can do: |phi| (rad), |dphi/dt| (rad/s), |torque| (N m)."""

    angle_limit: SI = declared(ANGLE_LIMIT, "Largest |phi|, rad, below pi.", default=2.6)
    rate_limit: SI = declared(
        RATE_LIMIT, "Largest |dphi/dt|, rad/s; .inf: no limit.", default=math.pi
    )
    torque_limit: SI = declared(
        TORQUE_LIMIT, "Largest |torque|, N m; .inf: no limit.", default=1.37
    )


@dataclass(frozen=True)
class EffectUse:
    """An effect of the catalogue by name, with the values of its parameters in SI."""

    name: str
    values: Mapping[str, float]


@data
class Robot:
    """A Roller Racer. `physics` lists effects beyond the paper's model.

    `provenance` maps a key path such as `platform1.m` to a sentence that begins with
    measured, fitted or assumed.
    """

    platform1: Platform
    platform2: Platform
    h: SI = _parameter("h")
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
    def mass(self) -> float:
        """Of both platforms, kg."""
        return self.platform1.m + self.platform2.m

    def S1(self, phi: ArrayLike) -> Array:
        """c1 cos phi + c2 at an angle, m: 0 in a singular posture."""
        return self.platform1.c * np.cos(phi) + self.platform2.c

    @property
    def singular_angle(self) -> float:
        """The smallest |phi| at which S1 vanishes, rad; inf if never."""
        ratio = self.platform2.c / self.platform1.c
        return math.acos(-ratio) if ratio <= 1.0 else math.inf
