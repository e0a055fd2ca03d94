"""A part of the floor on which the wheels roll harder, or more easily.

It is a circle of a radius about (x, y), or, where the radius is 0, all that lies beyond a straight
edge through (edge_x, edge_y) in the direction `normal`. Each wheel feels the floor under itself,
and all that comes of its rolling there is so many times as much: its own viscous drag and its dry
friction, but not a drag that grows with the square of the speed, as that of the air does.
The border is smoothed over 5 mm, about the length of a wheel's contact with a carpet.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port, Setting
from rr_opt.mechanics.kinematics import Mechanism, Wheel, with_resistance

BORDER = 0.005
"""Over which the drag changes, m."""


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    def law(wheel: Wheel, u: ca.SX) -> ca.SX:
        place = mechanism.on_floor(wheel.platform, wheel.point)
        from_centre = place - ca.vertcat(values["x"], values["y"])
        distance = ca.sqrt(ca.sumsqr(from_centre) + BORDER**2 / 100)
        into = ca.vertcat(ca.cos(values["normal"]), ca.sin(values["normal"]))
        beyond = ca.dot(place - ca.vertcat(values["edge_x"], values["edge_y"]), into)
        depth = ca.if_else(values["radius"] > 0, values["radius"] - distance, beyond)
        inside = (1 + ca.tanh(depth / BORDER)) / 2
        return wheel.resists(u) * (values["multiplier"] - 1) * inside

    return with_resistance(mechanism, law)


def _near(setting: Setting) -> float:
    """So far a patch is moved with care: a part of the robot's length."""
    return (setting.robot.platform1.c + setting.robot.platform2.c) / 5


def _straight(setting: Setting) -> float:
    """The border of so large a circle is straight: that is the other form."""
    return max(2 * setting.room, 0.5)


EFFECT = Effect(
    name="floor_patch",
    family="floor",
    port=Port.FORCE,
    parameters=(
        Parameter("multiplier", "dimensionless", (0.0, 1000.0), 2.0, neutral=1.0),
        Parameter("x", "m", (-100.0, 100.0), 0.3, natural=_near, placed=True),
        Parameter("y", "m", (-100.0, 100.0), 0.3, natural=_near),
        Parameter(
            *("radius", "m", (0.0, 100.0), 0.3), natural=_near, least=4 * BORDER, most=_straight
        ),
        Parameter("normal", "rad", (-2 * math.pi, 2 * math.pi), 0.3),
        Parameter("edge_x", "m", (-100.0, 100.0), 0.3, natural=_near, placed=True),
        Parameter("edge_y", "m", (-100.0, 100.0), 0.3, natural=_near),
    ),
    sentence="On a part of the floor the wheels roll harder, or more easily, than elsewhere.",
    enter=_enter,
    forms=(("multiplier", "x", "y", "radius"), ("multiplier", "normal", "edge_x", "edge_y")),
    smooth=False,
)
