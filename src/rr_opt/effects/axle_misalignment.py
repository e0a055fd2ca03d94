"""Axles that are not square to their platforms: the wheels roll off to one side."""

from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism, with_turned_axles


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    return with_turned_axles(mechanism, values["toe1"], values["toe2"])


EFFECT = Effect(
    name="axle_misalignment",
    family="contact",
    port=Port.CONSTRAINT,
    parameters=(
        Parameter("toe1", "rad", (-0.3, 0.3), 0.02),
        Parameter("toe2", "rad", (-0.3, 0.3), 0.02),
    ),
    sentence="An axle is rotated about its centre, so its wheels steer to one side.",
    enter=_enter,
)
