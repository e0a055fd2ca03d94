"""A tracked point beside the joint P, on platform 1."""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Observation, rotated


def _observe(observation: Observation, values: Mapping[str, ca.SX]) -> Observation:
    shift = rotated(ca.vertcat(values["dx"], values["dy"]), observation.psi)
    return replace(observation, x=observation.x + shift[0], y=observation.y + shift[1])


EFFECT = Effect(
    name="marker_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(Parameter("dx", "m", (-0.2, 0.2), 0.005), Parameter("dy", "m", (-0.2, 0.2), 0.005)),
    sentence="The tracked point is not the joint but a nearby point on platform 1.",
    observe=_observe,
)
