"""A case as the text of its experiment.yaml: what the experimenter knows of it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from rr_opt.experiment.experiment import Uncertainty
from rr_opt.lab.case import Case, Plan
from rr_opt.lab.delivery import Delivery
from rr_opt.lab.markers import places
from rr_opt.robot.parameters import Platform, Robot

WRITTEN = "# Written by `rr-opt record`, which may write over it."
"""The first line of the file."""


def experiment_text(case: Case, delivery: Delivery) -> str:
    """experiment.yaml. Its values are written as JSON, which YAML reads."""
    noise = {"position": case.noise.position, "angle": case.noise.angle}
    if delivery.torque:
        noise["torque"] = case.noise.torque
    sections: dict[str, Any] = {"noise": noise, "uncertainty": _uncertainty(case.uncertainty)}
    if delivery.form != "csv":
        first, second = places(case.nominal)
        sections["markers"] = {"platform1": first, "platform2": second}
    lines = [WRITTEN, "robot:"]
    lines += [f"  {key}: {json.dumps(value)}" for key, value in _robot(case.nominal).items()]
    lines += [f"{key}: {json.dumps(value)}" for key, value in sections.items()]
    lines.append("recordings:")
    lines += [f"  - {json.dumps(_recording(plan, delivery))}" for plan in case.plans]
    return "\n".join(lines) + "\n"


def _robot(robot: Robot) -> dict[str, Any]:
    servo = robot.servo
    limits = ("angle_limit", "rate_limit", "torque_limit")
    record: dict[str, Any] = {
        "platform1": _platform(robot.platform1),
        "platform2": _platform(robot.platform2),
        "h": robot.h,
        "servo": {name: getattr(servo, name) for name in limits},
    }
    if robot.physics:
        record["physics"] = [{"name": use.name, **use.values} for use in robot.physics]
    return record


def _platform(part: Platform) -> dict[str, float]:
    return {name: getattr(part, name) for name in ("m", "I", "c", "a", "b", "kappa")}


def _uncertainty(known: Mapping[str, Uncertainty]) -> dict[str, float | str]:
    """1 sigma of each value, SI, or `unknown`."""
    return {
        name: "unknown" if each.factor is not None else float(f"{each.sigma:.6g}")
        for name, each in known.items()
    }


def _recording(plan: Plan, delivery: Delivery) -> dict[str, Any]:
    gait = plan.gait
    sine = {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset}
    entry = {"file": delivery.file(plan), "gait": sine, "use": plan.use, "start": plan.start}
    return {**entry, "servo_log": delivery.log(plan)} if delivery.servo_log else entry
