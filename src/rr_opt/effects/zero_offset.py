"""A capture system whose zeros are off: a constant is added to heading and servo angle."""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Observation


def _observe(observation: Observation, values: Mapping[str, ca.SX]) -> Observation:
    return replace(
        observation, psi=observation.psi + values["psi"], phi=observation.phi + values["phi"]
    )


EFFECT = Effect(
    name="zero_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(
        Parameter("psi", "rad", (-1.0, 1.0), 0.01),
        Parameter("phi", "rad", (-1.0, 1.0), 0.01),
    ),
    sentence="The capture system's zeros of heading and servo angle are off.",
    observe=_observe,
    candidate=False,
)
