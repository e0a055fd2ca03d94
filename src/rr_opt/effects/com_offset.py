"""Centres of mass to one side of the platforms' axes."""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    bodies = tuple(
        replace(body, point=body.point + ca.vertcat(0, values[f"d{body.platform}"]))
        for body in mechanism.bodies
    )
    return replace(mechanism, bodies=bodies)


EFFECT = Effect(
    name="com_offset",
    family="mass",
    port=Port.MASS,
    parameters=(Parameter("d1", "m", (-0.1, 0.1), 0.005), Parameter("d2", "m", (-0.1, 0.1), 0.005)),
    sentence="A platform's centre of mass lies to the left or right of its axis.",
    enter=_enter,
)
