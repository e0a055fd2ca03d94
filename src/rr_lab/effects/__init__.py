"""The effects that the laboratory can hide, by name and realisation."""

import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rr_lab.effects import catalogue
from rr_lab.effects.hidden_effect import HiddenEffect, Parameter, adds
from rr_lab.rig import Rig
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.outcome import InputError


def _parameter(name: str, row: Mapping[str, Any]) -> Parameter:
    own = dict(row)
    if not own.pop("strength", True):
        own["neutral"] = None
    return Parameter(name, **own)


def _effect(row: Mapping[str, Any]) -> HiddenEffect:
    """A row of `effects.toml`."""
    own = dict(row)
    for key in ("parameters", "also"):
        own[key] = tuple(_parameter(*item) for item in own.get(key, {}).items())
    for key in ("enter", "draw", "derived"):
        if key in own:
            own[key] = getattr(catalogue, f"_{own[key]}")
    if "adds" in own:
        own["enter"] = adds(*own.pop("adds"))
    for key in ("sizes", "same_as"):
        if key in own:
            own[key] = tuple(own[key])
    return HiddenEffect(**own)


_TABLE = Path(__file__).with_name("effects.toml")
EVERY = tuple(map(_effect, tomllib.loads(_TABLE.read_text(encoding="utf-8"))["effect"]))

REALISATIONS: dict[str, tuple[HiddenEffect, ...]] = {
    name: tuple(effect for effect in EVERY if effect.name == name)
    for name in dict.fromkeys(effect.name for effect in EVERY)
}
"""By name, the first being the one that a bare name stands for."""

NAMED = tuple(name for name, (first, *_) in REALISATIONS.items() if first.named)
OUTSIDE_NAMES = tuple(name for name in REALISATIONS if name not in NAMED)
"""Those that a diagnosis can name, and those outside its catalogue."""

_BY_KEY = {effect.key: effect for effect in EVERY} | {
    name: first for name, (first, *_) in REALISATIONS.items()
}


def effect_named(key: str) -> HiddenEffect:
    """By NAME or NAME/REALISATION; raises InputError if there is none."""
    if key not in _BY_KEY:
        name = key.partition("/")[0]
        known = [each.key for each in REALISATIONS.get(name, ())] or list(REALISATIONS)
        raise InputError(
            f"The laboratory cannot hide {key!r}. Expected one of: {', '.join(known)}. "
            "Correct the name."
        )
    return _BY_KEY[key]


def rig_with(robot: Robot, effects: Iterable[EffectUse] = ()) -> Rig:
    """The robot with the effects in it, in the order given; those in its own `physics` come first.

    Raises InputError for an effect or a parameter that is not known, or that is needed and missing.
    """
    rig = Rig(robot)
    for use in (*robot.physics, *effects):
        effect = effect_named(use.name)
        if unknown := sorted(set(use.values) - set(effect.accepted)):
            raise InputError(
                f"The effect {use.name} has no parameter {', '.join(unknown)}. Expected: "
                f"{', '.join(sorted(effect.accepted))}. Correct the name."
            )
        try:
            effect.enter(rig, use.values)
        except KeyError as missing:
            raise InputError(
                f"The effect {use.name} lacks its parameter {missing.args[0]}. It is needed. "
                "Give its value."
            ) from None
    return rig
