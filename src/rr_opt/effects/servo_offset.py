"""A servo whose zero is off: a constant is added to the commanded angle."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.drive import Drive, FreeJoint
from rr_opt.model.servo_command import LinearServo


def _actuate(command: Drive, values: Mapping[str, float], _: FreeJoint | None = None) -> Drive:
    shift = np.array([[values["offset"]], [0.0], [0.0]])
    return replace(command, at=lambda t: command.at(t) + shift)


EFFECT = Effect(
    name="servo_offset",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(Parameter("offset", "rad", (-0.5, 0.5), 0.02),),
    sentence="The servo's zero is off: the angle is the commanded one plus a constant.",
    actuate=_actuate,
    linear=lambda values: LinearServo(shift=values["offset"]),
)
