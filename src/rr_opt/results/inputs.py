"""What a study varies, in words: its keys, and their values in the unit that people think in."""

from __future__ import annotations

from typing import Any

import numpy as np

from rr_opt.files.study_axes import Axis
from rr_opt.files.study_keys import Key
from rr_opt.formatting import QUANTITIES, with_unit
from rr_opt.model.parameters import PARAMETERS, SYMBOLS

_LIKE = {"angle_limit": "angle", "rate_limit": "rate", "torque_limit": "torque"}
_SMALL = {"m": ("mm", 1e3), "N m s": ("µN m s", 1e6)}
"""SI unit -> the unit shown, and how many of it are one SI unit."""


def unit_of(key: Key) -> tuple[str, float]:
    """The unit, empty for none, and how many of it are one SI unit."""
    name = str(key.path[-1] if isinstance(key.path[-1], str) else key.path[-2])
    kind = QUANTITIES.get(_LIKE.get(name, name))
    unit, factor = kind.common if kind else (key.unit or "", 1.0)
    return _SMALL.get(unit, (unit, factor))


def value_text(key: Key, value: Any, digits: int = 4) -> str:
    """A value of a key for people: a float, SI, in their unit; infinity is `no limit`."""
    if not isinstance(value, float):
        return str(value)
    unit, factor = unit_of(key)
    return with_unit(factor * value, unit, digits) if np.isfinite(value) else "no limit"


def key_words(key: Key) -> str:
    """`rate limit` for limits.rate, `mass of platform 1` for robot.platform1.m; else the key."""
    *above, name = map(str, key.path)
    for parameter in PARAMETERS.values():
        if key.path == ("robot", *parameter.key):
            return parameter.full_words
    if above == ["limits"]:
        return "singularity margin" if name == "singularity" else f"{name} limit"
    if above == ["robot", "servo"]:
        return f"servo's {name.replace('_', ' ')}"
    if above in ([], ["gait"]) and name in QUANTITIES:
        return QUANTITIES[name].words
    return key.name


def axis_words(axis: Axis) -> str:
    """What varies along an axis: `masses of both platforms`, or the first key and how many more."""
    keys = [line.key for line in axis.lines]
    symbol = str(keys[0].path[-1])
    both = {("robot", f"platform{number}", symbol) for number in (1, 2)}
    if len(keys) == 2 and {key.path for key in keys} == both and symbol in SYMBOLS:
        return f"{SYMBOLS[symbol].plural} of both platforms"
    more = f" and {len(keys) - 1} more" if len(keys) > 1 else ""
    return key_words(keys[0]) + more


def setting_text(words: str, value: str) -> str:
    """`rate limit 30 rpm`, `no rate limit`."""
    if value == "no limit" and words.endswith(" limit"):
        return f"no {words}"
    return f"{words} {value}"


def held_words(held: tuple[str, ...]) -> list[str]:
    """The active limits and bounds of an optimum in words; `nothing` if there are none."""
    return [name.replace("inertia_ratio", "J20/J10") for name in held] or ["nothing"]
