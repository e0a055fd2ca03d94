"""A tracked point that is not the joint: x and y are those of a point beside P on platform 1."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Seen, rotated


def _observe(seen: Seen, values: Mapping[str, ca.SX]) -> Seen:
    shift = rotated(ca.vertcat(values["dx"], values["dy"]), seen.psi)
    return replace(seen, x=seen.x + shift[0], y=seen.y + shift[1])


EFFECT = Effect(
    name="marker_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(Parameter("dx", "m", (-0.2, 0.2), 0.005), Parameter("dy", "m", (-0.2, 0.2), 0.005)),
    sentence="The tracked point is not the joint but a point beside it on platform 1.",
    observe=_observe,
)
