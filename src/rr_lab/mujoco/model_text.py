"""A rig as MuJoCo's own model text: the numbers for the template `rig.xml`."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING, Any

from rr_lab.rig import GRIPS, WHEELS, Motor, Rig, swing_inertia
from rr_opt.model.robot import Platform

if TYPE_CHECKING:
    from jinja2 import Template

MOTOR_INERTIA = 1e9
"""kg m2. A flywheel too heavy for the robot to disturb, turned to the commanded angle, carries
platform 2 with it by a stiff constraint: the angle is given, as the nominal model has it."""

GEAR_INERTIA = 1e-3
"""kg m2, of the gear that play hangs on. Its turning is given, so it moves nothing else; with less,
MuJoCo would take the stops for as light as the gear, and make them soft."""

BEAM_INERTIA = 1e-3
"""kg m2, what swings on a bending beam, about; it sets its damping to a tenth of the critical."""

LOAD_INERTIA = 1e-6
"""kg m2, of a loose load."""

WHEEL_MASS = 5e-5
"""kg, of one wheel; taken from its platform's."""

HARD = 0.99
"""MuJoCo's impedance of a contact that holds. Nearer to 1 the four wheels, one more than a stiff
body needs to stand, chatter under large side forces."""

SLIDING = 0.5
"""The same of one that may slide. In MuJoCo a sliding contact pushes itself off the floor, by more
the faster it slides. What the four wheels do not agree on of that lifts some and loads others by as
much as their own weight, the harder the contacts the more: at 0.99 the side force of an axle was
between 0.3 and 2.3 times the friction of its load, at 0.5 it is within 1 % of it."""

GRIP_RATE = 1.9
"""How fast side slip is taken back, in units of 1/step. 2 would hold the mean of two steps' slips
at zero and thus be of second order, but never die out; 1 lags by half a step."""

TURNING_LOAD = 5e-5
"""kg, the least spin inertia of a wheel over h^2: what a wheel needs to be integrated at all."""


def model_text(rig: Rig, step: float) -> str:
    """The MJCF of a rig for a step of `step` s."""
    one, two = rig.robot.platform1, rig.robot.platform2
    J = spin_inertia(rig, step)
    return _template().render(
        rig=rig,
        step=step,
        h=rig.robot.h,
        platforms=[_platform(rig, 0, one, 1.0, J), _platform(rig, 1, two, -1.0, J)],
        drive=loop(rig),
        hard=HARD if rig.mu >= GRIPS else SLIDING,
        grip_rate=GRIP_RATE,
        motor_inertia=MOTOR_INERTIA,
        gear_inertia=GEAR_INERTIA,
        load_inertia=LOAD_INERTIA,
        load_place=one.joint_to_centre,
        load_damping=0.1 * (rig.load[0] * rig.load[1]) ** 0.5 if rig.load else 0.0,
        bend_damping=0.1 * ((rig.spring or 0.0) * BEAM_INERTIA) ** 0.5,
    )


@cache
def _template() -> Template:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    return Environment(
        loader=PackageLoader("rr_lab.mujoco", ""),
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
        autoescape=False,
    ).get_template("rig.xml")


def spin_inertia(rig: Rig, step: float) -> float:
    """Spin inertia that each wheel is given, kg m2, so that its friction stops it in many steps.

    It is taken back from the platform, so that the nominal robot has none.
    """
    k = max(rig.kappa) / rig.robot.h**2
    return rig.robot.h**2 * max(TURNING_LOAD, 8 * k * step)


def _platform(rig: Rig, i: int, part: Platform, ahead: float, J: float) -> dict[str, Any]:
    """Body and wheels of a platform, P at the origin, its axle `ahead` (+1) or behind (-1).

    A rolling wheel carries the inertia of a load J/h^2 at its place. Two of them are, as the axle
    does not slip, a load 2J/h^2 at its centre with the moment of inertia 2 b^2 J/h^2. These and the
    wheels' own mass are taken from the platform; what is left is its body.
    """
    h, left = rig.robot.h, rig.left[i]
    axle, centre = ahead * part.c, ahead * part.joint_to_centre
    each, thin = WHEEL_MASS + J / h**2, WHEEL_MASS * h**2 / 4
    m = part.m - 2 * each
    x, y = (part.m * centre - 2 * each * axle) / m, part.m * left / m
    about_p = part.I + part.m * (centre**2 + left**2)
    I = about_p - 2 * (each * (axle**2 + part.b**2) + thin) - m * (x**2 + y**2)
    wheels = [
        {
            "name": WHEELS[n],
            "y": side * part.b,
            "mass": WHEEL_MASS,
            "thin": thin,
            "armature": J - thin + rig.J[n],
            "kappa": rig.kappa[n],
            "quadratic": rig.quadratic[n],
            "dry": rig.dry[n],
        }
        for n, side in ((2 * i, 1), (2 * i + 1, -1))
    ]
    return {
        "number": i + 1,
        "mass": m,
        "place": (x, y, -h / 2),
        "moments": (0.6 * I, 0.6 * I, I),
        "axle": axle,
        "pivot": 0.0 if rig.spring is None else axle / 2,
        "toe": rig.toe[i],
        "wheels": wheels,
    }


def loop(rig: Rig) -> Motor | None:
    """What holds phi at the command: the servo's loop and the gear in series; None if
    both are stiff."""
    gear = None
    if rig.gear is not None:
        gear = Motor(rig.gear, 2 * (rig.gear * GEAR_INERTIA) ** 0.5)
    if rig.motor is None or gear is None:
        return rig.motor or gear
    stiffness = 1 / (1 / rig.motor.stiffness + 1 / gear.stiffness)
    return Motor(stiffness, rig.motor.damping, rig.motor.feedforward)


def longest_step(rig: Rig) -> float:
    """s, in which a compliant servo turns by a third of a radian of its own swing: explicit
    steps, as MuJoCo takes them, lose it at six times that."""
    drive = loop(rig)
    if drive is None:
        return math.inf
    inertia = GEAR_INERTIA if rig.play else swing_inertia(rig.robot)
    return 0.3 * min((inertia / drive.stiffness) ** 0.5, inertia / drive.damping)
