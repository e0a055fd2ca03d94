"""The effects that the laboratory can hide, by name."""

from __future__ import annotations

from collections.abc import Iterable

from rr_lab.effects.actuation import ACTUATION
from rr_lab.effects.contact import CONTACT
from rr_lab.effects.hidden import HiddenEffect
from rr_lab.effects.other import FLOOR, MASS, MEASUREMENT
from rr_lab.effects.outside import OUTSIDE
from rr_lab.effects.rolling import ROLLING
from rr_lab.rig import Rig
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.outcome import InputError

EFFECTS = {
    effect.name: effect
    for effect in (*ACTUATION, *ROLLING, *CONTACT, *FLOOR, *MASS, *MEASUREMENT, *OUTSIDE)
}
"""All of them; those outside the catalogue have `named` False."""


def effect_named(name: str) -> HiddenEffect:
    """By name; raises InputError if there is none."""
    if name not in EFFECTS:
        raise InputError(
            f"The laboratory cannot hide {name!r}. Expected one of: {', '.join(EFFECTS)}. "
            "Correct the name."
        )
    return EFFECTS[name]


def rig_with(robot: Robot, effects: Iterable[EffectUse] = ()) -> Rig:
    """The robot with the effects in it, in the order given; those in its own `physics` come first.

    Raises InputError for an effect or a parameter that is not known, or that is needed and missing.
    """
    rig = Rig(robot)
    for use in (*robot.physics, *effects):
        effect = effect_named(use.name)
        known = {parameter.name for parameter in effect.parameters}
        if unknown := sorted(set(use.values) - known - effect.further):
            raise InputError(
                f"The effect {use.name} has no parameter {', '.join(unknown)}. Expected: "
                f"{', '.join(sorted(known))}. Correct the name."
            )
        try:
            effect.enter(rig, use.values)
        except KeyError as missing:
            raise InputError(
                f"The effect {use.name} lacks its parameter {missing.args[0]}. It is needed. "
                "Give its value."
            ) from None
    return rig
