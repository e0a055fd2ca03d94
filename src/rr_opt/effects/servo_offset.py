"""A servo whose middle is not where its command says: a constant is added to the angle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.drive import Drive, FreeJoint


def _actuate(told: Drive, values: Mapping[str, float], _: FreeJoint | None = None) -> Drive:
    shift = np.array([[values["offset"]], [0.0], [0.0]])

    def at(t: Array) -> Array:
        return told.at(t) + shift

    return replace(told, at=at)


EFFECT = Effect(
    name="servo_offset",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(Parameter("offset", "rad", (-0.5, 0.5), 0.02),),
    sentence="The servo's zero is off: the angle is the commanded one and a constant.",
    actuate=_actuate,
)
