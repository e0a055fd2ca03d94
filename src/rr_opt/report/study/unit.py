"""The unit in which people think of a key that is varied."""

from __future__ import annotations

import math
from typing import Any

from rr_opt.files.study.units import Key
from rr_opt.report.quantities import QUANTITIES, with_unit

_LIKE = {"angle_limit": "angle", "rate_limit": "rate", "torque_limit": "torque"}


def unit_of(key: Key) -> tuple[str, float]:
    """The unit, empty for none, and how many of it are one SI unit."""
    name = str(key.path[-1] if isinstance(key.path[-1], str) else key.path[-2])
    kind = QUANTITIES.get(_LIKE.get(name, name))
    unit, factor = kind.common if kind else (key.unit or "", 1.0)
    return ("mm", 1e3) if unit == "m" else (unit, factor)


def value_text(key: Key, value: Any, digits: int = 4) -> str:
    """A value of a key for people: a float, SI, in their unit; infinity is `no limit`."""
    if not isinstance(value, float):
        return str(value)
    unit, factor = unit_of(key)
    return with_unit(factor * value, unit, digits) if math.isfinite(value) else "no limit"
