"""A robot as the mapping that a robot file holds, so that a result can be read back as one."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from rr_opt.robot.parameters import Robot


def robot_record(robot: Robot) -> dict[str, Any]:
    """The robot in SI under the keys of a robot file; an endless limit is null."""
    return {
        "name": robot.name,
        "platform1": asdict(robot.platform1),
        "platform2": asdict(robot.platform2),
        "h": robot.h,
        "servo": {key: finite(value) for key, value in asdict(robot.servo).items()},
        "physics": [{"name": use.name, **use.values} for use in robot.physics],
        "provenance": _nested(dict(robot.provenance)),
    }


def finite(value: float) -> float | None:
    """The value, or None (null in JSON) if it is infinite or not a number."""
    return float(value) if math.isfinite(value) else None


def _nested(flat: dict[str, str]) -> dict[str, Any]:
    """`{"servo.rate_limit": text}` as mappings in mappings."""
    nested: dict[str, Any] = {}
    for path, text in flat.items():
        *sections, key = path.split(".")
        place = nested
        for section in sections:
            place = place.setdefault(section, {})
        place[key] = text
    return nested
