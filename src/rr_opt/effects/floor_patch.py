"""A part of the floor on which the wheels roll harder, or more easily.

It is a circle about (x, y) or, if its radius is 0, a strip that starts at a straight edge through
(edge_x, edge_y) and extends from there along `normal`, for its width or without end. Each wheel
feels the floor under itself, which multiplies its viscous drag and its dry friction, but not a drag
that grows with the square of the speed, such as that of the air.

The border, of a strip the nearer one, is smoothed over 5 mm, about the length of a wheel's contact
with a carpet.
"""

import math
from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.effect import Effect, OperatingRange, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism, Wheel, with_resistance

BORDER = 0.005
"""Width over which the drag changes, m."""


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    def law(wheel: Wheel, u: ca.SX) -> ca.SX:
        place = mechanism.floor_position(wheel.platform, wheel.point)
        from_centre = place - ca.vertcat(values["x"], values["y"])
        distance = ca.sqrt(ca.sumsqr(from_centre) + BORDER**2 / 100)
        into = ca.vertcat(ca.cos(values["normal"]), ca.sin(values["normal"]))
        beyond = ca.dot(place - ca.vertcat(values["edge_x"], values["edge_y"]), into)
        strip = ca.fmin(beyond, values["width"] - beyond)
        depth = ca.if_else(values["radius"] > 0, values["radius"] - distance, strip)
        inside = (1 + ca.tanh(depth / BORDER)) / 2
        return wheel.resistance(u) * (values["multiplier"] - 1) * inside

    return with_resistance(mechanism, law)


def _near(operated: OperatingRange) -> float:
    """A fifth of the robot's length: the scale on which a patch is located."""
    return (operated.robot.platform1.c + operated.robot.platform2.c) / 5


def _straight(operated: OperatingRange) -> float:
    """The border of a larger circle is as good as straight: that is the other form."""
    return max(2 * operated.extent, 0.5)


EFFECT = Effect(
    name="floor_patch",
    family="floor",
    port=Port.FORCE,
    parameters=(
        Parameter("multiplier", "dimensionless", (0.0, 1000.0), 2.0, neutral=1.0),
        Parameter("x", "m", (-100.0, 100.0), 0.3, typical_for=_near, guess_from_data=True),
        Parameter("y", "m", (-100.0, 100.0), 0.3, typical_for=_near),
        Parameter(
            *("radius", "m", (0.0, 100.0), 0.3),
            typical_for=_near,
            fit_lower=4 * BORDER,
            fit_upper=_straight,
        ),
        Parameter("normal", "rad", (-2 * math.pi, 2 * math.pi), 0.3),
        Parameter("edge_x", "m", (-100.0, 100.0), 0.3, typical_for=_near, guess_from_data=True),
        Parameter("edge_y", "m", (-100.0, 100.0), 0.3, typical_for=_near),
        Parameter(
            *("width", "m", (0.0, 100.0), 0.3),
            neutral=100.0,
            typical_for=_near,
            fit_lower=4 * BORDER,
            fit_upper=_straight,
        ),
    ),
    sentence="On part of the floor the wheels roll with more or less resistance than elsewhere.",
    enter=_enter,
    forms=(
        ("multiplier", "x", "y", "radius"),
        ("multiplier", "normal", "edge_x", "edge_y"),
        ("multiplier", "normal", "edge_x", "edge_y", "width"),
    ),
    differentiable=False,
)
