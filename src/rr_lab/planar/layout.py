"""The geometry of a rig as expressions of its coordinates.

P is at (x, y), platform 1 heads to psi from P to its axle, and platform 2's axis, from its axle to
P, is turned by phi relative to that. Some rigs have further coordinates: the motor's shaft before
a backlash, the two displacements of a loose pin, a bend of each platform, a load's shift.
"""

from dataclasses import dataclass

import casadi as ca

from rr_lab.rig import Rig
from rr_opt.model.robot import Platform


@dataclass(frozen=True)
class Body:
    """A mass (kg) with its moment of inertia (kg m2); place (2, m) of its centre, heading (rad)."""

    m: float
    I: float
    place: ca.SX
    heading: ca.SX


@dataclass(frozen=True)
class Wheel:
    """The contact point of a wheel on the floor (2, m), and its heading (rad)."""

    place: ca.SX
    heading: ca.SX


@dataclass(frozen=True)
class PlanarLayout:
    """q (n) are the coordinates, m and rad, by name; ends are the platforms' joint ends, x, y and
    heading (3). The first two bodies are the platforms; wheels are in the order of WHEELS."""

    names: tuple[str, ...]
    q: ca.SX
    bodies: tuple[Body, ...]
    wheels: tuple[Wheel, ...]
    ends: tuple[ca.SX, ca.SX]

    def of(self, name: str) -> ca.SX:
        """A coordinate, by name."""
        return self.q[self.names.index(name)]


def axis(heading: ca.SX) -> ca.SX:
    """The unit vector (2) of a heading."""
    return ca.vertcat(ca.cos(heading), ca.sin(heading))


def left_of(ahead: ca.SX) -> ca.SX:
    """A vector (2) turned by +90 degrees."""
    return ca.vertcat(-ahead[1], ahead[0])


def coordinates(rig: Rig) -> tuple[str, ...]:
    """The names of a rig's coordinates."""
    names = ["x", "y", "psi", "phi"]
    names += ["shaft"] if rig.play else []
    names += ["pin_ahead", "pin_left"] if rig.pin else []
    names += ["bend1", "bend2"] if rig.spring is not None else []
    names += ["shift"] if rig.load is not None else []
    return tuple(names)


def layout(rig: Rig) -> PlanarLayout:
    """The rig in the plane."""
    names = coordinates(rig)
    q = ca.SX.sym("q", len(names))

    def of(name: str) -> ca.SX:
        return q[names.index(name)] if name in names else ca.SX(0)

    one, two = rig.robot.platform1, rig.robot.platform2
    psi = of("psi")
    at1, turned2 = ca.vertcat(of("x"), of("y")), psi + of("phi")
    ahead1 = axis(psi)
    at2 = at1 + of("pin_ahead") * ahead1 + of("pin_left") * left_of(ahead1)
    bodies = [_body(rig, 0, one, 1.0, at1, psi), _body(rig, 1, two, -1.0, at2, turned2)]
    if rig.load is not None:
        place = at1 + one.joint_to_centre * ahead1 + of("shift") * left_of(ahead1)
        bodies.append(Body(rig.load[0], 0.0, place, psi))
    wheels = (
        *_axle(rig, 0, one, 1.0, at1, psi, of("bend1")),
        *_axle(rig, 1, two, -1.0, at2, turned2, of("bend2")),
    )
    ends = ca.vertcat(at1, psi), ca.vertcat(at2, turned2)
    return PlanarLayout(names, q, tuple(bodies), wheels, ends)


def _body(rig: Rig, i: int, part: Platform, ahead: float, joint: ca.SX, heading: ca.SX) -> Body:
    """A platform whose axle is `ahead` (+1) of its joint or behind it (-1). Its mass, if moved to
    the left, keeps I about its centre."""
    along = axis(heading)
    place = joint + ahead * part.joint_to_centre * along + rig.left[i] * left_of(along)
    return Body(part.m, part.I, place, heading)


def _axle(
    rig: Rig, i: int, part: Platform, ahead: float, joint: ca.SX, heading: ca.SX, bend: ca.SX
) -> tuple[Wheel, Wheel]:
    """Its wheels, left and right. A bending platform does so half way to its axle."""
    half = ahead * part.c / 2
    centre = joint + half * axis(heading) + half * axis(heading + bend)
    heads = heading + bend + rig.toe[i]
    aside = part.b * left_of(axis(heads))
    return Wheel(centre + aside, heads), Wheel(centre - aside, heads)
