"""Wheels that slip sideways so little that their speed follows their force at once.

It is `lateral_slip` to first order in the compliance. The axles are still held by the constraint,
and give way to it: with F the force that it takes to hold an axle's two wheels, they move sideways
at -creep F/2. There is no state to come to rest, so the motion is not stiff, and it is
differentiable where the compliance vanishes: a score test needs no more.
"""

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.kinematics import Mechanism


def _enter(mechanism: Mechanism, values: Mapping[str, ca.SX]) -> Mechanism:
    return replace(mechanism, creep=values["creep_compliance"])


EFFECT = Effect(
    name="lateral_creep",
    family="contact",
    port=Port.FORCE,
    parameters=(Parameter("creep_compliance", "m/(N s)", (0.0, 20.0), 0.002),),
    sentence="The wheels slip sideways a little under load.",
    enter=_enter,
    accelerated=True,
    candidate=False,
)
