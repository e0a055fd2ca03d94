"""Where everything is on the two platforms, and how fast each part of them moves.

Each platform has axes of its own: the origin at the centre C of its axle, the first axis along the
platform (from C as the paper draws its arrow: away from the joint P on platform 1, towards P on
platform 2), the second to the left. Positions in these axes are constant:

                     platform 1            platform 2
    axle's centre    C1 = (0, 0)           C2 = (0, 0)
    joint            P  = (-c1, 0)         P  = (c2, 0)
    centre of mass   A1 = (-a1, 0)         A2 = (a2, 0)
    wheels                (0, +-b1)             (0, +-b2)

Any motion is described by four speeds u = (v, s1, s2, dphi): the speed of axle 1 along its rolling
direction, the side speeds of both axles, and the joint rate. A point r of platform i moves at
V_i + w_i x r, and P belongs to both platforms, so with R the rotation by phi

    (v, s1 - c1 w1) = R (u2, s2 + c2 w2),        w2 = w1 + dphi

which determines the yaw rate w1 and the speed u2 of axle 2 along its own axis. With s1 = s2 = 0
these are the paper's constraints (1) and (2), and S1 = c1 cos phi + c2 is the divisor of w1.

An axle may be turned by an angle toe against its platform. Then v, s1, u2, s2 are taken along the
rolling direction and perpendicular to it, (v, s1) = R(-toe1) V_1, and with n2 the side direction of
axle 2 the joint gives, in that direction alone,

    w1 (c1 cos(phi + toe2) + c2 cos toe2) = (V_1 rotated by -phi) . n2 - s2 - c2 cos toe2 dphi
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import casadi as ca

from rr_opt.model.parameters import PARAMETERS, parameters_of
from rr_opt.model.robot import Robot

G = 9.80665
"""Standard acceleration of free fall, m/s2 (3rd General Conference on Weights and Measures)."""


@dataclass(frozen=True)
class Observation:
    """What is recorded, as expressions: tracked point x, y (m), heading psi and angle phi (rad)."""

    x: ca.SX
    y: ca.SX
    psi: ca.SX
    phi: ca.SX


ROBOT_PARAMETERS = tuple(name.replace("kappa", "k") for name in PARAMETERS)
"""Those of the equations of motion, where friction enters along the floor, as k = kappa/h^2."""

SPEEDS = ("v", "s1", "s2", "dphi")


def robot_values(robot: Robot) -> tuple[float, ...]:
    """The values of ROBOT_PARAMETERS, SI."""
    return tuple((parameters_of(robot) | {"kappa1": robot.k1, "kappa2": robot.k2}).values())


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


Law = Callable[["Wheel", ca.SX], ca.SX]
"""law(wheel, u): force along the rolling direction, N, of a wheel that rolls at u, m/s."""


@dataclass(frozen=True)
class Wheel:
    """A wheel of platform 1 or 2, on its left (+1) or right (-1), at a point (2, m) of it.

    direction   unit vector (2,) along which it rolls, in the platform's axes
    resistances forces that come from rolling on this floor, and scale with it; air drag does not,
                and is not among them
    """

    platform: int
    side: int
    point: ca.SX
    direction: ca.SX
    resistances: tuple[Law, ...] = ()

    def resistance(self, u: ca.SX) -> ca.SX:
        """The force of the floor along the rolling direction, N, at the rolling speed u, m/s.

        A law is given the wheel as it was before, so that it may build on the resistance of then.
        """
        laws = self.resistances
        return sum(
            (law(replace(self, resistances=laws[:k]), u) for k, law in enumerate(laws)), ca.SX(0)
        )


@dataclass(frozen=True)
class Force:
    """A force (2, N) at a point (2, m) of platform 1 or 2, both in the platform's axes."""

    platform: int
    point: ca.SX
    vector: ca.SX


@dataclass(frozen=True)
class Mechanism:
    """The robot as bodies and forces over symbols; effects return a changed copy.

    pose            x, y of the joint P (m) and psi (rad) on the floor (3,)
    phi, speeds     the joint angle (rad) and SPEEDS (4,)
    parameters      symbol of every robot parameter by name
    frames          motion of platforms 1 and 2
    constrained     the side speeds that are zero by constraint
    for_prediction  forces change sign as steeply as those of the real robot; else as smoothly as
                    an optimiser needs
    creep           m/(N s): axles held by the constraint give way to it, by so much times the force
                    on each of their wheels; None if they do not
    """

    pose: ca.SX
    phi: ca.SX
    speeds: ca.SX
    parameters: Mapping[str, ca.SX]
    frames: Mapping[int, Frame]
    bodies: tuple[Body, ...]
    rotors: tuple[Rotor, ...]
    wheels: tuple[Wheel, ...]
    forces: tuple[Force, ...] = ()
    constrained: frozenset[str] = frozenset({"s1", "s2"})
    for_prediction: bool = False
    creep: ca.SX | None = None

    def rolling_speed(self, wheel: Wheel) -> ca.SX:
        """Speed of the contact point along the rolling direction, m/s."""
        return ca.dot(wheel.direction, self.frames[wheel.platform].velocity(wheel.point))

    def joint(self, platform: int) -> ca.SX:
        """The joint P (2, m) in the axes of platform 1 or 2."""
        return ca.vertcat(-self.parameters["c1"] if platform == 1 else self.parameters["c2"], 0)

    def heading(self, platform: int) -> ca.SX:
        """Angle of the platform's axis on the floor, rad."""
        return self.pose[2] if platform == 1 else self.pose[2] + self.phi

    def floor_position(self, platform: int, point: ca.SX) -> ca.SX:
        """Position on the floor (2, m) of a point (2, m) of a platform."""
        return self.pose[:2] + rotated(point - self.joint(platform), self.heading(platform))


def rotated(vector: ca.SX, angle: ca.SX | float) -> ca.SX:
    """A vector (2,) turned counter-clockwise by an angle, rad."""
    cos, sin = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1])


def mechanism() -> Mechanism:
    """The paper's robot: two bodies, four wheels, viscous friction k at each of them."""
    p = {name: ca.SX.sym(name) for name in ROBOT_PARAMETERS}
    pose = ca.vertcat(*(ca.SX.sym(name) for name in ("x", "y", "psi")))
    speeds = ca.vertcat(*(ca.SX.sym(name) for name in SPEEDS))
    return _assembled(pose, ca.SX.sym("phi"), speeds, p, ca.SX(0), ca.SX(0))


def with_turned_axles(mechanism: Mechanism, toe1: ca.SX, toe2: ca.SX) -> Mechanism:
    """The paper's robot over the same symbols, its axles turned counter-clockwise, rad.

    It is assembled anew, as every force depends on the axles: other effects have to enter later.
    """
    old = mechanism
    turned = _assembled(old.pose, old.phi, old.speeds, old.parameters, toe1, toe2)
    return replace(turned, for_prediction=old.for_prediction)


def _assembled(
    pose: ca.SX, phi: ca.SX, speeds: ca.SX, p: Mapping[str, ca.SX], toe1: ca.SX, toe2: ca.SX
) -> Mechanism:
    v, s1, s2, dphi = ca.vertsplit(speeds)
    c1, c2 = p["c1"], p["c2"]
    V1 = rotated(ca.vertcat(v, s1), toe1)
    cos, sin = ca.cos(phi + toe2), ca.sin(phi + toe2)
    reach = c2 * ca.cos(toe2)
    w1 = (V1[1] * cos - V1[0] * sin - s2 - reach * dphi) / (c1 * cos + reach)
    w2 = w1 + dphi
    u2 = V1[0] * cos + (V1[1] - c1 * w1) * sin - c2 * w2 * ca.sin(toe2)
    V2 = rotated(ca.vertcat(u2, s2), toe2)
    bare = Mechanism(
        pose=pose,
        phi=phi,
        speeds=speeds,
        parameters=MappingProxyType(dict(p)),
        frames={1: Frame(V1, w1), 2: Frame(V2, w2)},
        bodies=(
            Body(1, p["m1"], ca.vertcat(-p["a1"], 0)),
            Body(2, p["m2"], ca.vertcat(p["a2"], 0)),
        ),
        rotors=(Rotor(p["I1"], w1), Rotor(p["I2"], w2)),
        wheels=tuple(
            Wheel(
                number,
                side,
                rotated(ca.vertcat(0, side * p[f"b{number}"]), toe),
                ca.vertcat(ca.cos(toe), ca.sin(toe)),
            )
            for number, toe in ((1, toe1), (2, toe2))
            for side in (1, -1)
        ),
    )
    return with_resistance(bare, lambda wheel, u: -p[f"k{wheel.platform}"] * u)


def with_resistance(mechanism: Mechanism, law: Law) -> Mechanism:
    """Add at every wheel a rolling force that comes from the floor."""
    wheels = tuple(
        replace(wheel, resistances=(*wheel.resistances, law)) for wheel in mechanism.wheels
    )
    return replace(with_wheel_forces(mechanism, law), wheels=wheels)


def with_wheel_forces(mechanism: Mechanism, law: Law) -> Mechanism:
    """Add at every wheel a rolling force that does not come from the floor."""
    added = tuple(
        Force(
            wheel.platform,
            wheel.point,
            law(wheel, mechanism.rolling_speed(wheel)) * wheel.direction,
        )
        for wheel in mechanism.wheels
    )
    return replace(mechanism, forces=mechanism.forces + added)


def wheel_loads(p: Mapping[str, ca.SX]) -> dict[int, ca.SX]:
    """Force, N, with which each wheel of platform 1 and of platform 2 presses on the floor.

    In the straight posture, from the balance of moments about either axle; at 0.9 rad it differs by
    half a per cent.
    """
    length = p["c1"] + p["c2"]
    on1 = (p["m1"] * (length - p["a1"]) + p["m2"] * p["a2"]) / length
    on2 = p["m1"] + p["m2"] - on1
    return {1: G * on1 / 2, 2: G * on2 / 2}
