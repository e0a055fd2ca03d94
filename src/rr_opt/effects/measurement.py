"""What the capture system makes of the motion: a point, a zero or a clock of its own."""

from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port, Symbols
from rr_opt.mechanics.kinematics import Observation, rotated


def _marker_offset(observation: Observation, values: Symbols) -> Observation:
    shift = rotated(ca.vertcat(values["dx"], values["dy"]), observation.psi)
    return replace(observation, x=observation.x + shift[0], y=observation.y + shift[1])


MARKER_OFFSET = Effect(
    name="marker_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(Parameter("dx", "m", (-0.2, 0.2), 0.005), Parameter("dy", "m", (-0.2, 0.2), 0.005)),
    sentence="The tracked point is not the joint but a point beside it on platform 1.",
    observe=_marker_offset,
)


def _zero_offset(observation: Observation, values: Symbols) -> Observation:
    return replace(
        observation, psi=observation.psi + values["psi"], phi=observation.phi + values["phi"]
    )


ZERO_OFFSET = Effect(
    name="zero_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(
        Parameter("psi", "rad", (-1.0, 1.0), 0.01),
        Parameter("phi", "rad", (-1.0, 1.0), 0.01),
    ),
    sentence="The capture system measures heading and servo angle from a zero that is off.",
    observe=_zero_offset,
    candidate=False,
)

# A recording with a clock of its own: its time t is the command's time t + offset.
CLOCK_OFFSET = Effect(
    name="clock_offset",
    family="measurement",
    port=Port.MEASUREMENT,
    parameters=(Parameter("offset", "s", (-0.5, 0.5), 0.01),),
    sentence="The recording's clock and the command's clock differ, by the same in all runs.",
    delay="offset",
)
