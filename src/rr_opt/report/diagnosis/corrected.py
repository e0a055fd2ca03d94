"""The robot with what a diagnosis found in it, and its file, which every other verb reads."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from rr_opt.diagnose.diagnosis import Diagnosis
from rr_opt.experiment.experiment import Experiment
from rr_opt.physics.effects import OF_ROBOTS
from rr_opt.report.robot_record import robot_record
from rr_opt.robot.parameters import EffectUse, Platform, Robot, Servo

_PARTS = ("m", "I", "c", "a", "b", "kappa")
_DIGITS = 7
"""Of a fitted value that are written: more than any recording tells."""


def corrected_robot(experiment: Experiment, found: Diagnosis) -> Robot:
    """The nominal robot with the re-estimated values, the accepted effects, and where from."""
    robot = experiment.robot
    fitted = {name: _rounded(value) for name, value in found.values.items()}
    return replace(
        robot,
        platform1=_platform(robot.platform1, 1, fitted),
        platform2=_platform(robot.platform2, 2, fitted),
        h=fitted.get("h", robot.h),
        servo=_servo(robot.servo, fitted),
        physics=_physics(robot, fitted),
        provenance=MappingProxyType({**robot.provenance, **_provenance(experiment, found)}),
        name=f"{robot.name or experiment.name}, corrected",
    )


def robot_yaml(robot: Robot, title: str) -> str:
    """The robot as the text of a robot file; title: a comment on its first line."""
    record = robot_record(robot)
    lines = [f"# {line}" for line in title.splitlines()]
    for key, value in record.items():
        if key in ("physics", "provenance"):
            continue
        given = {k: math.inf if v is None else v for k, v in value.items()} if key == "servo" else (
            value
        )  # fmt: skip
        lines.append(f"{key}: {_flow(given)}")
    if record["physics"]:
        lines += ["physics:", *(f"  - {_flow(one)}" for one in record["physics"])]
    if record["provenance"]:
        lines += ["provenance:", *_block(record["provenance"], "  ")]
    return "\n".join(lines) + "\n"


def _platform(platform: Platform, number: int, fitted: Mapping[str, float]) -> Platform:
    own = {part: fitted[f"{part}{number}"] for part in _PARTS if f"{part}{number}" in fitted}
    return replace(platform, **own)


def _servo(servo: Servo, fitted: Mapping[str, float]) -> Servo:
    """The servo, no faster than it was seen to be: gaits are then sought that it can make."""
    seen = fitted.get("servo_rate_limit.rate_limit", math.inf)
    return replace(servo, rate_limit=min(servo.rate_limit, seen))


def _physics(robot: Robot, fitted: Mapping[str, float]) -> tuple[EffectUse, ...]:
    """The effects that the robot had, and those that were fitted."""
    uses = {use.name: dict(use.values) for use in robot.physics}
    for name, value in fitted.items():
        effect, dot, parameter = name.partition(".")
        if dot:
            uses.setdefault(effect, {})[parameter] = _within(effect, parameter, value)
    return tuple(EffectUse(name, MappingProxyType(values)) for name, values in uses.items())


def _within(effect: str, parameter: str, value: float) -> float:
    """The value inside its bounds, which rounding may have left."""
    low, high = next(q.bounds for q in OF_ROBOTS[effect].parameters if q.name == parameter)
    return min(max(value, low), high)


def _provenance(experiment: Experiment, found: Diagnosis) -> dict[str, str]:
    used = sum(run.use == "fit" for run in experiment.runs)
    source = f"{used} recording{'s' if used != 1 else ''} of {experiment.name or 'an experiment'}"
    told = {}
    for name, one in found.parameters.items():
        interval = f"{one.low:.4g} to {one.high:.4g} {one.unit}".removesuffix(" dimensionless")
        told[_key(name)] = f"fitted: {interval} (95 %), {source}"
    return told


def _key(name: str) -> str:
    """Where a robot file keeps a quantity: `kappa1` under `platform1.kappa`."""
    if "." in name:
        return f"physics.{name}"
    return f"platform{name[-1]}.{name[:-1]}" if name[-1] in "12" else name


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")


def _block(mapping: Mapping[str, Any], indent: str) -> list[str]:
    lines: list[str] = []
    for key, value in mapping.items():
        if isinstance(value, Mapping):
            lines += [f"{indent}{key}:", *_block(value, f"{indent}  ")]
        else:
            lines.append(f"{indent}{key}: {_flow(value)}")
    return lines


def _flow(value: Any) -> str:
    """A value in one line, as both versions of YAML read it: a number has a point."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {_flow(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if math.isinf(value):
        return ".inf" if value > 0 else "-.inf"
    mantissa, e, power = repr(float(value)).partition("e")
    return f"{mantissa if '.' in mantissa else mantissa + '.0'}{e}{power}"
