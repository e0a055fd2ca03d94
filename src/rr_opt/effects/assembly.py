"""Parts of the robot that do not sit where its drawing has them."""

from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port, Symbols
from rr_opt.mechanics.kinematics import Mechanism, with_turned_axles


def _axle_misalignment(mechanism: Mechanism, values: Symbols) -> Mechanism:
    return with_turned_axles(mechanism, values["toe1"], values["toe2"])


AXLE_MISALIGNMENT = Effect(
    name="axle_misalignment",
    family="contact",
    port=Port.CONSTRAINT,
    parameters=(
        Parameter("toe1", "rad", (-0.3, 0.3), 0.02),
        Parameter("toe2", "rad", (-0.3, 0.3), 0.02),
    ),
    sentence="An axle is turned about its centre, so that its wheels roll off to one side.",
    enter=_axle_misalignment,
)


def _com_offset(mechanism: Mechanism, values: Symbols) -> Mechanism:
    bodies = tuple(
        replace(body, point=body.point + ca.vertcat(0, values[f"d{body.platform}"]))
        for body in mechanism.bodies
    )
    return replace(mechanism, bodies=bodies)


COM_OFFSET = Effect(
    name="com_offset",
    family="mass",
    port=Port.MASS,
    parameters=(Parameter("d1", "m", (-0.1, 0.1), 0.005), Parameter("d2", "m", (-0.1, 0.1), 0.005)),
    sentence="A platform's centre of mass lies to the left of its axis, or to the right.",
    enter=_com_offset,
)
