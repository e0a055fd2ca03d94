"""Robots, gaits and results as plain data, as JSON and YAML hold them; and gaits read back.

A gait always has `shape`, `amplitude`, `period` and `offset`; a fourier gait adds `sines` and
`cosines`, a free gait `angle0`, `rate0` and `accelerations`.
"""

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Annotated, Any, Literal

import yaml
from pydantic import Field

from rr_opt.files.fields import FileModel, Key, keys_of, validate
from rr_opt.files.issue import Issue
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import shown, unknown_word
from rr_opt.model.gait import AMPLITUDE, OFFSET, FourierGait, FreeGait, Gait, SineGait
from rr_opt.model.robot import Robot


def plain(value: Any) -> Any:
    """A value as plain JSON data: None for NaN and infinity, a list for an array, a mapping for a
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
    """The robot in SI under the keys of a robot file; infinity means no limit."""
    sections = {
        "platform1": dataclasses.asdict(robot.platform1),
        "platform2": dataclasses.asdict(robot.platform2),
        "h": robot.h,
        "servo": dataclasses.asdict(robot.servo),
    }
    physics = {use.name: use.values for use in robot.physics}
    return {
        "name": robot.name,
        **sections,
        "physics": [{"name": use.name, **use.values} for use in robot.physics],
        "provenance": _nested(robot.provenance, {**sections, "physics": physics}),
    }


def rounded(value: float) -> float:
    """A fitted value rounded for writing, to more digits than any recording determines."""
    return float(f"{value:.7g}")


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


def _nested(flat: Mapping[str, str], robot: Mapping[str, Any]) -> dict[str, Any]:
    """`{"servo.rate_limit": text}` as nested mappings.

    A text on a whole section goes to each of its keys if one of them has its own.
    """
    nested: dict[str, Any] = {}
    for path, text in flat.items():
        *sections, key = path.split(".")
        place, values = nested, robot
        for section in sections:
            values = values.get(section, {}) if isinstance(values, Mapping) else {}
            if isinstance(whole := place.setdefault(section, {}), str):
                place[section] = dict.fromkeys(values, whole)
            place = place[section]
        place[key] = text
    return nested


_AMPLITUDE = Annotated[float | None, Key(AMPLITUDE)]
_OFFSET = Annotated[float | None, Key(OFFSET)]
_LARGEST = "largest |phi - offset|, rad."


class SineRecord(keys_of(SineGait)):
    """phi(t) = amplitude sin(2 pi t/period) + offset."""

    shape: Literal["sine"] = Field(default="sine", description="`sine`")
    offset: _OFFSET = Field(description="offset, rad.")


class FourierRecord(keys_of(FourierGait)):
    """phi(t) = offset + sum of sines[n-1] sin(2 pi n t/period) + cosines[n-1] cos(2 pi n t/period).

    The amplitude follows from the sines and cosines.
    """

    shape: Literal["fourier"] = Field(description="`fourier`")
    amplitude: _AMPLITUDE = Field(default=None, description=_LARGEST)


class FreeRecord(keys_of(FreeGait)):
    """phi(t) with a constant acceleration on each of many equal intervals of the period.

    Amplitude and offset follow from the other values.
    """

    shape: Literal["free"] = Field(description="`free`")
    amplitude: _AMPLITUDE = Field(default=None, description=_LARGEST)
    offset: _OFFSET = Field(default=None, description="mean of phi, rad.")


_SHAPES: dict[str, tuple[type[FileModel], Any]] = {
    "sine": (SineRecord, SineGait),
    "fourier": (FourierRecord, FourierGait),
    "free": (FreeRecord, FreeGait),
}

_ROUNDING = 1e-6
"""Rounding error allowed in a record written by a program, relative to the gait's size."""


def gait_record(gait: Gait) -> dict[str, Any]:
    """The gait in SI, complete: `gait_from` restores it to the last digit."""
    size = {name: getattr(gait, name) for name in ("shape", "amplitude", "period", "offset")}
    own: Any = gait
    values = {one.name: getattr(gait, one.name) for one in fields(own)}
    return size | {key: list(v) if isinstance(v, tuple) else v for key, v in values.items()}


def gait_from(document: FileData) -> tuple[Gait | None, list[Issue]]:
    """The gait that a mapping describes (None if there are issues), and all issues."""
    shape = document.data.get("shape", "sine")
    if not isinstance(shape, str):
        message = f"Read {shown(shape)}. Expected one of: {', '.join(_SHAPES)}."
        return None, [document.error(("shape",), message)]
    if shape not in _SHAPES:
        message = unknown_word(shape, list(_SHAPES), "word")
        return None, [document.error(("shape",), message)]
    record, kind = _SHAPES[shape]
    model, issues = validate(record, document)
    if model is None:
        return None, issues
    values = dict(model)
    gait: Any = kind(**{one.name: values[one.name] for one in fields(kind)})
    wrong: list[tuple[str, str]] = []
    if isinstance(gait, FourierGait) and len(gait.sines) != len(gait.cosines):
        message = (
            f"Read {len(gait.cosines)} cosines and {len(gait.sines)} sines. Expected as many of "
            "each. Write 0 for those that are missing."
        )
        wrong.append(("cosines", message))
    else:
        wrong += _open_ends(gait) if isinstance(gait, FreeGait) else ()
        wrong += _disagreements(gait, values) if shape != "sine" else ()
    issues += [document.error((key,), message) for key, message in wrong]
    return (None if issues else gait), issues


def _open_ends(gait: FreeGait) -> Iterator[tuple[str, str]]:
    """Key and message if a free gait does not close after a period."""
    ends = zip(("angle", "rate"), gait.nodes, ("rad", "rad/s"), strict=True)
    for what, values, unit in ends:
        gap = float(values[-1] - values[0])
        if not abs(gap) <= _ROUNDING * (1 + abs(values).max()):
            yield (
                "accelerations",
                f"After a period the {what} is {gap:.3g} {unit} from where it began. Expected it "
                "to come back, so that the gait can be repeated. Correct rate0 or accelerations.",
            )


def _disagreements(
    gait: FourierGait | FreeGait, given: dict[str, Any]
) -> Iterator[tuple[str, str]]:
    """Key and message where a redundant value is given that disagrees with the others."""
    if gait.amplitude == 0:
        yield (
            "amplitude",
            "Read a gait that does not move the servo. Expected one that does: its values make "
            "an amplitude of 0. Correct them.",
        )
    for key in ("amplitude", "offset"):
        value, made = given[key], getattr(gait, key)
        if value is not None and not abs(value - made) <= _ROUNDING * (1 + gait.peak_angle):
            yield (
                key,
                f"Read {value:.6g} rad. Expected {made:.6g} rad, which is what the gait's other "
                f"values make. Correct them, or delete {key}.",
            )
