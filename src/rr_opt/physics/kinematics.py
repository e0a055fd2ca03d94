"""Where everything on the robot is: points and directions as functions of q = (x, y, psi, phi).

`P = (x, y)` is the joint, psi the heading of platform 1 (from P towards its axle), phi the
angle of platform 2's axis relative to platform 1's (the paper's Fig. 1):

    C1 = P + c1 e1      A1 = C1 - a1 e1      e1 = (cos psi, sin psi)
    C2 = P - c2 e2      A2 = C2 + a2 e2      e2 = (cos(psi + phi), sin(psi + phi))

Only positions are written here; every velocity follows by differentiation in `dynamics`.
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


def robot_values(robot: Robot) -> tuple[float, ...]:
    """The numbers behind ROBOT_PARAMETERS, in their order, SI."""
    one, two = robot.platform1, robot.platform2
    return (
        *(one.m, one.I, one.c, one.a, one.b, robot.k1),
        *(two.m, two.I, two.c, two.a, two.b, robot.k2),
        robot.h,
    )


@dataclass(frozen=True)
class Body:
    """A rigid body: mass (kg), moment of inertia about `centre` (kg m2), centre (2), angle (rad)."""

    mass: ca.SX
    inertia: ca.SX
    centre: ca.SX
    angle: ca.SX


@dataclass(frozen=True)
class Axle:
    """A wheel pair's axle: its centre (2), and the unit vectors along which its wheels roll and
    across which they may not slip."""

    centre: ca.SX
    along: ca.SX
    across: ca.SX


@dataclass(frozen=True)
class Wheel:
    """A wheel of platform 1 or 2, on its left (+1) or right (-1), its contact point (2) and the
    direction in which it rolls (2)."""

    platform: int
    side: int
    contact: ca.SX
    along: ca.SX


@dataclass(frozen=True)
class Force:
    """A force (2, N) that acts at a point (2) of the mechanism."""

    point: ca.SX
    vector: ca.SX


@dataclass(frozen=True)
class Mechanism:
    """The robot as points, bodies and forces over symbols; effects return a changed copy.

    q, qd       (4,) x, y, psi, phi and their rates
    parameters  symbol of every robot parameter by name
    held        numbers of the axles whose side speed is held at zero
    spin        kinetic energy beside that of `bodies`, J (wheels turning about their axles)
    """

    q: ca.SX
    qd: ca.SX
    parameters: Mapping[str, ca.SX]
    bodies: tuple[Body, ...]
    axles: tuple[Axle, Axle]
    wheels: tuple[Wheel, ...]
    forces: tuple[Force, ...] = ()
    held: frozenset[int] = frozenset({1, 2})
    spin: ca.SX = ca.SX(0)

    def velocity(self, point: ca.SX) -> ca.SX:
        """Velocity (2, m/s) of a point given as a function of q."""
        return ca.jtimes(point, self.q, self.qd)

    def rolling_speed(self, wheel: Wheel) -> ca.SX:
        """Speed of the wheel's contact point along its rolling direction, m/s."""
        return ca.dot(self.velocity(wheel.contact), wheel.along)


def mechanism() -> Mechanism:
    """The paper's robot: two bodies, four wheels, viscous friction k at each of them."""
    q = ca.SX.sym("q", 4)
    qd = ca.SX.sym("qd", 4)
    p = {name: ca.SX.sym(name) for name in ROBOT_PARAMETERS}
    joint, psi, phi = q[:2], q[2], q[3]
    e1, n1 = _axes(psi)
    e2, n2 = _axes(psi + phi)
    C1 = joint + p["c1"] * e1
    C2 = joint - p["c2"] * e2
    bodies = (
        Body(p["m1"], p["I1"], C1 - p["a1"] * e1, psi),
        Body(p["m2"], p["I2"], C2 + p["a2"] * e2, psi + phi),
    )
    wheels = tuple(
        Wheel(number, side, C + side * p[f"b{number}"] * n, e)
        for number, C, e, n in ((1, C1, e1, n1), (2, C2, e2, n2))
        for side in (1, -1)
    )
    bare = Mechanism(
        q, qd, MappingProxyType(p), bodies, (Axle(C1, e1, n1), Axle(C2, e2, n2)), wheels
    )
    return with_wheel_forces(bare, lambda wheel, u: -p[f"k{wheel.platform}"] * u)


def with_wheel_forces(
    mechanism: Mechanism, law: Callable[[Wheel, ca.SX], ca.SX]
) -> Mechanism:
    """Add at every wheel the rolling force law(wheel, u), N along the wheel, u its speed, m/s."""
    added = tuple(
        Force(wheel.contact, law(wheel, mechanism.rolling_speed(wheel)) * wheel.along)
        for wheel in mechanism.wheels
    )
    return replace(mechanism, forces=mechanism.forces + added)


def _axes(angle: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Unit vectors along and to the left of an axis at `angle`."""
    return (
        ca.vertcat(ca.cos(angle), ca.sin(angle)),
        ca.vertcat(-ca.sin(angle), ca.cos(angle)),
    )
