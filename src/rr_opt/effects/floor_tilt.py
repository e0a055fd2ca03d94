"""A floor that is not level: gravity pulls every mass downhill."""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Force, G, Mechanism, rotated


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    downhill = G * ca.vertcat(values["tilt_x"], values["tilt_y"])
    pulls = tuple(
        Force(
            body.platform,
            body.point,
            body.mass * rotated(downhill, -mechanism.heading(body.platform)),
        )
        for body in mechanism.bodies
    )
    return replace(mechanism, forces=mechanism.forces + pulls)


EFFECT = Effect(
    name="floor_tilt",
    family="floor",
    port=Port.FORCE,
    parameters=(
        Parameter("tilt_x", "rad", (-0.2, 0.2), 0.002),
        Parameter("tilt_y", "rad", (-0.2, 0.2), 0.002),
    ),
    sentence="The floor slopes, and gravity pulls the robot downhill.",
    enter=_enter,
    unmodelled=("a tether that pulls one way",),
)
