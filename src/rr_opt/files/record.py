"""Robots, gaits and results as plain data, as JSON and YAML hold them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import yaml

from rr_opt.files.gait_record import gait_record
from rr_opt.model.gait import FourierGait, FreeGait, SineGait
from rr_opt.model.robot import Robot


def plain(value: Any) -> Any:
    """A value as JSON has it: None for NaN and infinity, a list for an array, a mapping for a
    dataclass, and a gait as in result.json."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, tuple | list):
        return [plain(each) for each in value]
    if isinstance(value, SineGait | FourierGait | FreeGait):
        return plain(gait_record(value))
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = dataclasses.fields(value)
        return {field.name: plain(getattr(value, field.name)) for field in fields}
    return value


def robot_record(robot: Robot) -> dict[str, Any]:
    """The robot in SI under the keys of a robot file; a limit that does not exist is infinite."""
    return {
        "name": robot.name,
        "platform1": dataclasses.asdict(robot.platform1),
        "platform2": dataclasses.asdict(robot.platform2),
        "h": robot.h,
        "servo": dataclasses.asdict(robot.servo),
        "physics": [{"name": use.name, **use.values} for use in robot.physics],
        "provenance": _nested(dict(robot.provenance)),
    }


def robot_yaml(robot: Robot, title: str) -> str:
    """The robot as the text of a robot file; title: a comment on its first lines."""
    record = {key: value for key, value in robot_record(robot).items() if value not in ([], {})}
    origins = {key: record.pop(key) for key in ["provenance"] if key in record}
    style: Any = {"sort_keys": False, "allow_unicode": True, "width": 120}
    return "".join(
        [
            *(f"# {line}\n" for line in title.splitlines()),
            yaml.safe_dump(record, default_flow_style=None, **style),
            yaml.safe_dump(origins, **style) if origins else "",
        ]
    )


def yaml_text(content: Mapping[str, Any], title: str) -> str:
    """Plain data as YAML under a comment."""
    text = yaml.safe_dump(dict(content), sort_keys=False, default_flow_style=None)
    return f"# {title}\n{text}"


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
