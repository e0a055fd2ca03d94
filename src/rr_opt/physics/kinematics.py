"""Where everything sits on the two platforms, and how fast each part of them moves.

Each platform has axes of its own: the origin at its axle's centre C, the first axis along the
platform (from C towards where the paper draws its arrow: away from the joint P on platform 1,
towards P on platform 2), the second to the left. Positions are fixed numbers in these axes:

                     platform 1            platform 2
    axle's centre    C1 = (0, 0)           C2 = (0, 0)
    joint            P  = (-c1, 0)         P  = (c2, 0)
    centre of mass   A1 = (-a1, 0)         A2 = (a2, 0)
    wheels                (0, +-b1)             (0, +-b2)

Any motion is named by four speeds: u = (v, s1, s2, dphi), the speed of axle 1 along its rolling
direction, the side speeds of both axles, and the servo's rate. A point r of platform i moves at
V_i + w_i x r, and P belongs to both platforms, so with R the rotation by phi

    (v, s1 - c1 w1) = R (u2, s2 + c2 w2),        w2 = w1 + dphi

which gives the yaw rate w1 and the speed u2 of axle 2 along its own axis. With s1 = s2 = 0 these
are the paper's constraints (1) and (2), and S1 = c1 cos phi + c2 is the divisor of w1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import casadi as ca

from rr_opt.robot.parameters import Robot

ROBOT_PARAMETERS = (
    *("m1", "I1", "c1", "a1", "b1", "k1"),
    *("m2", "I2", "c2", "a2", "b2", "k2"),
    "h",
)

SPEEDS = ("v", "s1", "s2", "dphi")


def robot_values(robot: Robot) -> tuple[float, ...]:
    """The numbers behind ROBOT_PARAMETERS, in their order, SI."""
    one, two = robot.platform1, robot.platform2
    return (
        *(one.m, one.I, one.c, one.a, one.b, robot.k1),
        *(two.m, two.I, two.c, two.a, two.b, robot.k2),
        robot.h,
    )


@dataclass(frozen=True)
class Frame:
    """A platform's motion: velocity of its origin in its own axes (2, m/s), yaw rate (rad/s)."""

    origin: ca.SX
    rate: ca.SX

    def velocity(self, point: ca.SX) -> ca.SX:
        """Velocity (2, m/s) of a point (2, m) fixed on the platform, in the platform's axes."""
        return self.origin + self.rate * ca.vertcat(-point[1], point[0])


@dataclass(frozen=True)
class Body:
    """A mass (kg) at a point (2, m) of platform 1 or 2."""

    platform: int
    mass: ca.SX
    point: ca.SX


@dataclass(frozen=True)
class Rotor:
    """A moment of inertia (kg m2) that turns at a rate (rad/s) of its own."""

    inertia: ca.SX
    rate: ca.SX


@dataclass(frozen=True)
class Wheel:
    """A wheel of platform 1 or 2, on its left (+1) or right (-1), at a point (2, m) of it."""

    platform: int
    side: int
    point: ca.SX


@dataclass(frozen=True)
class Force:
    """A force (2, N) at a point (2, m) of platform 1 or 2, both in the platform's axes."""

    platform: int
    point: ca.SX
    vector: ca.SX


@dataclass(frozen=True)
class Mechanism:
    """The robot as bodies and forces over symbols; effects return a changed copy.

    phi, speeds  the angle (rad) and SPEEDS (4,)
    parameters   symbol of every robot parameter by name
    frames       motion of platforms 1 and 2
    held         the side speeds that are held at zero
    """

    phi: ca.SX
    speeds: ca.SX
    parameters: Mapping[str, ca.SX]
    frames: Mapping[int, Frame]
    bodies: tuple[Body, ...]
    rotors: tuple[Rotor, ...]
    wheels: tuple[Wheel, ...]
    forces: tuple[Force, ...] = ()
    held: frozenset[str] = frozenset({"s1", "s2"})

    def rolling_speed(self, wheel: Wheel) -> ca.SX:
        """Speed of the wheel's contact point along its rolling direction, m/s."""
        return self.frames[wheel.platform].velocity(wheel.point)[0]


def mechanism() -> Mechanism:
    """The paper's robot: two bodies, four wheels, viscous friction k at each of them."""
    p = {name: ca.SX.sym(name) for name in ROBOT_PARAMETERS}
    phi = ca.SX.sym("phi")
    speeds = ca.vertcat(*(ca.SX.sym(name) for name in SPEEDS))
    v, s1, s2, dphi = ca.vertsplit(speeds)
    cos, sin = ca.cos(phi), ca.sin(phi)
    c1, c2 = p["c1"], p["c2"]
    w1 = (s1 * cos - v * sin - s2 - c2 * dphi) / (c1 * cos + c2)
    u2 = v * cos + (s1 - c1 * w1) * sin
    w2 = w1 + dphi
    bare = Mechanism(
        phi=phi,
        speeds=speeds,
        parameters=MappingProxyType(p),
        frames={1: Frame(ca.vertcat(v, s1), w1), 2: Frame(ca.vertcat(u2, s2), w2)},
        bodies=(
            Body(1, p["m1"], ca.vertcat(-p["a1"], 0)),
            Body(2, p["m2"], ca.vertcat(p["a2"], 0)),
        ),
        rotors=(Rotor(p["I1"], w1), Rotor(p["I2"], w2)),
        wheels=tuple(
            Wheel(number, side, ca.vertcat(0, side * p[f"b{number}"]))
            for number in (1, 2)
            for side in (1, -1)
        ),
    )
    return with_wheel_forces(bare, lambda wheel, u: -p[f"k{wheel.platform}"] * u)


def with_wheel_forces(mechanism: Mechanism, law: Callable[[Wheel, ca.SX], ca.SX]) -> Mechanism:
    """Add at every wheel the rolling force law(wheel, u), N along the wheel, u its speed, m/s."""
    added = tuple(
        Force(
            wheel.platform,
            wheel.point,
            ca.vertcat(law(wheel, mechanism.rolling_speed(wheel)), 0),
        )
        for wheel in mechanism.wheels
    )
    return replace(mechanism, forces=mechanism.forces + added)
