"""What the bearings of the wheels resist with in the plane."""

from __future__ import annotations

import math
from typing import Any

import casadi as ca

from rr_lab.laws import Drift, Falling, Patch, RollingResistance, Rub
from rr_lab.planar.forces import Moment
from rr_lab.rig import WHEELS, Rig, wheel_loads
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
