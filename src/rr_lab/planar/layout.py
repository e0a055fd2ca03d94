"""What the bearings of the wheels resist with in the plane."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import casadi as ca

from rr_lab.planar.forces import Moment
from rr_lab.rig import WHEELS, Drift, Falling, Patch, Rig, RollingResistance, Rub, wheel_loads
from rr_opt.model.robot import Platform
from rr_opt.outcome import InputError

DRY_ONSET = 2e-3
"""m/s at the rim, over which dry friction sets in if the rig does not say, as
u/(u^4 + onset^4)^(1/4): at three times that speed it is within a third of a per cent of its
force."""

EDGE = 1e-3
"""m, half the width of a patch's edge: about the length over which a tyre touches the floor."""

_SOFT = 0.02
"""Of the cosine of a wheel's angle, over which a fault begins and ends: some degrees."""


def bearings(moment: Moment, rig: Rig) -> list[ca.SX]:
    """D of each wheel, N m s: it resists with D times its spin."""
    viscous: list[Any] = [ca.SX(kappa) for kappa in rig.kappa]
    dry: list[Any] = [ca.SX(torque) for torque in rig.dry]
    carried = wheel_loads(rig)
    for law in rig.laws:
        for n in range(len(WHEELS)):
            viscous[n], dry[n] = _changed(law, moment, n, carried[n], viscous[n], dry[n])
    onset = (rig.onset or DRY_ONSET) / rig.robot.h
    found = []
    for n, quadratic in enumerate(rig.quadratic):
        spin = moment.spins[n]
        rubs = dry[n] / (spin**4 + onset**4) ** 0.25
        found.append(viscous[n] + quadratic * ca.fabs(spin) + rubs)
    return found


def _changed(
    law: Any, moment: Moment, n: int, load: float, viscous: ca.SX, dry: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """Viscous (N m s) and dry (N m) friction of a wheel by one more law."""
    match law:
        case Patch():
            place = moment.layout.wheels[n].place
            inside = (1 + ca.tanh(law.within.depth(place[0], place[1]) / EDGE)) / 2
            factor = 1 + (law.times - 1) * inside
            return viscous * factor, dry * factor
        case Falling():
            fall = ca.exp(-((moment.spins[n] / law.rate) ** 2))
            return viscous, dry + law.torque * (1 + 2 * fall) / 3
        case Drift():
            came = 1 - ca.exp(-ca.fmax(moment.t, 0) / law.time)
            return viscous * (1 + law.change * came), dry
        case RollingResistance():
            return viscous, dry + law.mu * law.h * load
        case Rub():
            return viscous, dry + (law.torque * _first_fifth(moment.turns[0]) if n == 0 else 0.0)
    raise InputError(
        f"The planar engine does not know {type(law).__name__}. Expected a law of the catalogue. "
        "Take the engine mujoco."
    )


def _first_fifth(turned: ca.SX) -> ca.SX:
    """1 over the first fifth of each turn, 0 over the rest."""
    middle = 0.2 * math.pi
    return (1 + ca.tanh((ca.cos(turned - middle) - math.cos(middle)) / _SOFT)) / 2


@dataclass(frozen=True)
class Body:
    """A mass (kg) with its moment of inertia (kg m2); place (2, m) of its centre, heading (rad)."""

    m: float
    I: float
    place: ca.SX
    heading: ca.SX


@dataclass(frozen=True)
class Wheel:
    """Where a wheel touches the floor (2, m), and the way it heads (rad)."""

    place: ca.SX
    heading: ca.SX


@dataclass(frozen=True)
class Layout:
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


def layout(rig: Rig) -> Layout:
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
    return Layout(names, q, tuple(bodies), wheels, ends)


def _body(rig: Rig, i: int, part: Platform, ahead: float, joint: ca.SX, heading: ca.SX) -> Body:
    """A platform whose axle is `ahead` (+1) of its joint or behind it (-1). Moved to the left, its
    mass keeps I about its centre."""
    along = axis(heading)
    place = joint + ahead * part.joint_to_centre * along + rig.left[i] * left_of(along)
    return Body(part.m, part.I, place, heading)


def _axle(
    rig: Rig, i: int, part: Platform, ahead: float, joint: ca.SX, heading: ca.SX, bend: ca.SX
) -> tuple[Wheel, Wheel]:
    """Its wheels, left and right. A platform that bends does so half way to its axle."""
    half = ahead * part.c / 2
    centre = joint + half * axis(heading) + half * axis(heading + bend)
    heads = heading + bend + rig.toe[i]
    aside = part.b * left_of(axis(heads))
    return Wheel(centre + aside, heads), Wheel(centre - aside, heads)
