"""Wheels of a pair that differ in friction about their mean."""

from collections.abc import Mapping

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism, with_resistance


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    k = mechanism.parameters
    return with_resistance(
        mechanism,
        lambda wheel, u: (
            -k[f"k{wheel.platform}"] * wheel.side * values[f"asymmetry{wheel.platform}"] * u
        ),
    )


EFFECT = Effect(
    name="left_right_drag",
    family="rolling",
    port=Port.FORCE,
    parameters=(
        Parameter("asymmetry1", "dimensionless", (-1.0, 1.0), 0.2),
        Parameter("asymmetry2", "dimensionless", (-1.0, 1.0), 0.2),
    ),
    sentence="The left wheels roll with more or less resistance than the right ones.",
    enter=_enter,
)
