"""The unit in which people think of a key that is varied."""

from __future__ import annotations

from rr_opt.files.study.units import Key
from rr_opt.report.quantities import QUANTITIES

_LIKE = {"angle_limit": "angle", "rate_limit": "rate", "torque_limit": "torque"}


def unit_of(key: Key) -> tuple[str, float]:
    """The unit, empty for none, and how many of it are one SI unit."""
    name = str(key.path[-1] if isinstance(key.path[-1], str) else key.path[-2])
    kind = QUANTITIES.get(_LIKE.get(name, name))
    unit, factor = kind.common if kind else (key.unit or "", 1.0)
    return ("mm", 1e3) if unit == "m" else (unit, factor)
