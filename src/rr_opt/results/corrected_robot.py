"""The robot with what a diagnosis found in it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from rr_opt.effects import OF_ROBOTS
from rr_opt.model.experiment import Experiment
from rr_opt.model.parameters import PARAMETERS, with_parameters
from rr_opt.model.robot import EffectUse, Robot, Servo
from rr_opt.sysid.diagnosis import Diagnosis

_DIGITS = 7
"""Of a fitted value that are written: more than any recording determines."""


def corrected_robot(experiment: Experiment, found: Diagnosis) -> Robot:
    """The nominal robot with the re-estimated values, the accepted effects, and where from."""
    robot = experiment.robot
    fitted = {name: _rounded(value) for name, value in found.values.items()}
    return replace(
        with_parameters(robot, {name: v for name, v in fitted.items() if name in PARAMETERS}),
        servo=_servo(robot.servo, fitted),
        physics=_physics(robot, fitted),
        provenance=MappingProxyType({**robot.provenance, **_provenance(experiment, found)}),
        name=f"{robot.name or experiment.name}, corrected",
    )


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
    origins = {}
    for name, one in found.parameters.items():
        interval = f"{one.low:.4g} to {one.high:.4g} {one.unit}".removesuffix(" dimensionless")
        origins[_key(name)] = f"fitted: {interval} (95 %), {source}"
    return origins


def _key(name: str) -> str:
    """Where a robot file keeps a quantity: `kappa1` under `platform1.kappa`."""
    if name in PARAMETERS:
        return ".".join(PARAMETERS[name].key)
    return f"physics.{name}" if "." in name else name


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")
