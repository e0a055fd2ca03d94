"""A case as the files of its folder: experiment.yaml, recordings, logs; its sealed answer."""

import hashlib
import json
import secrets
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import PurePath
from typing import Any, Literal

import numpy as np

from rr_lab.case import Case, Plan, motion_of, recorded, servo_angles, stream
from rr_lab.effects import effect_named
from rr_lab.formats import ServoClock, c3d_bytes, log_text, marker_data, places, vicon_text
from rr_opt.model.experiment import Recording
from rr_opt.model.parameters import PARAMETERS, PLATFORM_SYMBOLS, Uncertainty, parameters_of
from rr_opt.model.robot import EffectUse, Platform, Robot

Form = Literal["csv", "vicon", "c3d"]


@dataclass(frozen=True)
class Delivery:
    """The files of a run.

    form       `csv` has the joint and the angles; `vicon` and `c3d` have the markers
    servo_log  whether each run comes with the servo's log; clock: of that log
    torque     whether the servo's torque is in the CSV
    """

    form: Form = "csv"
    servo_log: bool = False
    clock: ServoClock = field(default_factory=ServoClock)
    torque: bool = False

    def file(self, plan: Plan) -> str:
        """The name of a run's recording."""
        return PurePath(plan.name).stem + (".c3d" if self.form == "c3d" else ".csv")

    def log(self, plan: Plan) -> str:
        """The name of a run's servo log."""
        return f"{PurePath(plan.name).stem}-servo.csv"


_WRITTEN = "# Written by `rr-opt record`, which may write over it while it is unchanged: crc32 "


def is_own(content: bytes) -> bool:
    """Whether it is an unchanged experiment.yaml written by `record`."""
    first, _, rest = content.partition(b"\n")
    return first == _first_line(rest)


def _first_line(rest: bytes) -> bytes:
    return f"{_WRITTEN}{zlib.crc32(rest):08x}".encode()


def experiment_text(case: Case, delivery: Delivery) -> str:
    """experiment.yaml. Its values are written as JSON, which YAML reads."""
    noise = {"position": case.noise.position, "angle": case.noise.angle}
    if delivery.torque:
        noise["torque"] = case.noise.torque
    sections: dict[str, Any] = {"noise": noise, "uncertainty": _uncertainty(case.uncertainty)}
    if delivery.form != "csv":
        first, second = places(case.nominal)
        sections["markers"] = {"platform1": first, "platform2": second}
    lines = ["robot:"]
    lines += [f"  {key}: {json.dumps(value)}" for key, value in _robot(case.nominal).items()]
    lines += [f"{key}: {json.dumps(value)}" for key, value in sections.items()]
    lines.append("recordings:")
    lines += [f"  - {json.dumps(_recording(plan, delivery))}" for plan in case.plans]
    text = "\n".join(lines) + "\n"
    return f"{_first_line(text.encode()).decode()}\n{text}"


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
    return {name: float(f"{getattr(part, name):.12g}") for name in PLATFORM_SYMBOLS}


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


PLAIN = Delivery()


def folder_of(
    case: Case, delivery: Delivery = PLAIN, progress: Callable[[str], None] = lambda _: None
) -> Iterator[tuple[str, bytes]]:
    """Names and contents of the files of a case, each made on demand.

    `progress` is called before each recording. Raises InputError if a package that the
    form needs is missing.
    """
    for n, plan in enumerate(case.plans):
        progress(f"recording {n + 1} of {len(case.plans)}")
        yield delivery.file(plan), _recorded(case, plan, n, delivery)
        if delivery.servo_log:
            log = log_text(partial(servo_angles, case, plan), plan.seconds, delivery.clock)
            yield delivery.log(plan), log.encode()
    # Written last, so that a folder with this file is complete.
    yield "experiment.yaml", experiment_text(case, delivery).encode()


def _recorded(case: Case, plan: Plan, n: int, delivery: Delivery) -> bytes:
    if delivery.form == "csv":
        return csv_text(recorded(case, n, torque=delivery.torque)).encode()
    markers = marker_data(
        motion_of(case, plan),
        case.nominal,
        case.noise.position,
        stream(case.seed, "noise", n),
        tracked=case.rig.tracked,
        missing=case.missing,
    )
    return vicon_text(markers).encode() if delivery.form == "vicon" else c3d_bytes(markers)


def csv_text(recording: Recording) -> str:
    """t and the channels, SI; missing values are empty."""
    lines = [",".join(("t", *recording.channels))]
    columns = [recording.data(channel) for channel in recording.channels]
    for t, *row in zip(recording.t, *columns, strict=True):
        values = ("" if np.isnan(value) else f"{value:.6f}" for value in row)
        lines.append(",".join((f"{t:.3f}", *values)))
    return "\n".join(lines) + "\n"


def answer(case: Case) -> dict[str, Any]:
    """Verdict and effects with the values of their parameters, as plain data."""
    return {
        "verdict": case.verdict,
        "effects": _effects(case),
        "case": case.name,
        "engine": case.engine,
        **({"disturbance": case.disturbance} if case.disturbance else {}),
        "seed": case.seed,
        "rms_deviation_from_nominal_in_sigma": dict(case.notes),
    }


def _effects(case: Case) -> list[dict[str, Any]]:
    if case.verdict == "parameters":
        true = parameters_of(case.robot)
        return [
            {"name": name, "parameters": {name: _valued(true[name], PARAMETERS[name].unit)}}
            for name in case.changed
        ]
    return [_effect(case.nominal, use) for use in case.effects]


def _effect(robot: Robot, use: EffectUse) -> dict[str, Any]:
    """One effect: the parameters of the catalogue, and separately the laboratory's own."""
    effect = effect_named(use.name)
    what = effect.what if effect.named else f"{effect.name}: {effect.what}"
    realisation = effect.realisation if effect.named else effect.name
    parameters, plant = {}, {}
    for name, value in use.values.items():
        each = effect.accepted[name]
        (plant if each.plant else parameters)[name] = _valued(value, each.unit)
    known = effect_named(effect.name).accepted
    for name, value in (effect.derived(robot, use.values) if effect.derived else {}).items():
        parameters[name] = _valued(value, known[name].unit)
    record: dict[str, Any] = {"name": effect.name if effect.named else "unknown", "what": what}
    if realisation:
        record["realisation"] = realisation
    if effect.same_as:
        record["same_as"] = list(effect.same_as)
    return {**record, "parameters": parameters, **({"plant": plant} if plant else {})}


def _valued(value: float, unit: str) -> dict[str, Any]:
    return {"value": float(f"{value:.9g}"), "unit": unit}


def sealed_text(case: Case) -> str:
    """The answer as JSON text, with a random word, so that its hash reveals nothing."""
    return json.dumps({**answer(case), "salt": secrets.token_hex(16)}, indent=2) + "\n"


def seal_of(text: str) -> str:
    """SHA-256 of a sealed answer's text, as hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()
