"""A capture system whose zeros are off: it tells heading and servo angle too large by so much."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Seen


def _observe(seen: Seen, values: Mapping[str, ca.SX]) -> Seen:
    return replace(seen, psi=seen.psi + values["psi"], phi=seen.phi + values["phi"])


EFFECT = Effect(
    name="zero_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(
        Parameter("psi", "rad", (-1.0, 1.0), 0.01),
        Parameter("phi", "rad", (-1.0, 1.0), 0.01),
    ),
    sentence="The capture system tells heading and servo angle from a zero that is off.",
    observe=_observe,
    nameless=True,
)
