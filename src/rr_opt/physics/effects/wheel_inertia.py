"""The wheels' own moment of inertia about their axles, which spins up as they roll."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.physics.effects.effect import Effect, Parameter, Port
from rr_opt.physics.kinematics import Mechanism, Rotor


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    h = mechanism.parameters["h"]
    wheels = tuple(
        Rotor(values["J"], mechanism.rolling_speed(wheel) / h) for wheel in mechanism.wheels
    )
    return replace(mechanism, rotors=mechanism.rotors + wheels)


EFFECT = Effect(
    name="wheel_inertia",
    family="rolling",
    port=Port.MASS,
    parameters=(Parameter("J", "kg m^2", (0.0, 1e-2), 1e-6),),
    sentence="Turning the wheels about their axles takes energy of its own.",
    enter=_enter,
)
