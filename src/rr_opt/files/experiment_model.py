"""The experiment file's keys: the robot, the capture system, and what was recorded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Annotated, Any, Literal

from pydantic import Field, GetJsonSchemaHandler, SkipValidation, create_model
from pydantic_core import CoreSchema

from rr_opt.files.fields import Count, Quantity, Spread, Uncertain
from rr_opt.files.gait_record import FourierRecord, FreeRecord, SineRecord
from rr_opt.files.robot_file import FileModel, RobotModel
from rr_opt.model.experiment import CountScale, Noise, Start, Uncertainty, Use
from rr_opt.model.robot import Robot

_UNITS = {"m": "kg", "I": "kg m^2", "c": "m", "a": "m", "b": "m", "kappa": "N m s"}
"""Groups: each stands for the value of both platforms, `m` for `m1` and `m2`."""
_MEANINGS = {
    "m": "masses",
    "I": "moments of inertia",
    "c": "distances from axle to joint",
    "a": "distances from axle to centre of mass",
    "b": "half tracks",
    "kappa": "viscous wheel frictions",
    "h": "wheel radius",
}
_DEFAULTS: dict[str, Any] = {
    "m": "1 %",
    "I": "5 %",
    "c": "2 mm",
    "a": "2 mm",
    "b": "2 mm",
    "h": "0.5 mm",
    "kappa": "unknown",
}
_ZEROS = ("psi_zero", "phi_zero")
_EXAMPLES = {"kg": "5 g", "kg m^2": "1e-4", "m": "2 mm", "N m s": "1e-6"}


def _fields() -> Iterator[tuple[str, Any]]:
    def optional(name: str, unit: str, example: str, description: str, absolute: bool) -> Any:
        kind = Annotated[Spread | None, Uncertain(unit, example, absolute)]
        standard = f" Default: {_DEFAULTS[name]}." if name in _DEFAULTS else ""
        return kind, Field(default=None, description=f"One sigma of {description}.{standard}")

    for key, unit in _UNITS.items():
        yield key, optional(key, unit, _EXAMPLES[unit], f"the {_MEANINGS[key]}, {unit}", False)
        for number in "12":
            told = f"platform {number}'s {key}, {unit}"
            yield f"{key}{number}", optional(f"{key}{number}", unit, _EXAMPLES[unit], told, False)
    yield "h", optional("h", "m", "0.5 mm", "the wheel radius, m", False)
    for key in _ZEROS:
        yield key, optional(key, "rad", "5 mrad", f"the zero of {key[:3]}, rad; else exact", True)


UncertaintyModel: Any = create_model(
    "UncertaintyModel",
    __base__=FileModel,
    __doc__="How well nominal values are known: `2 mm`, `5 %`, or `unknown`, free within a factor "
    "of 5. `m` stands for `m1` and `m2`, which go before it; 0 is exact.",
    **dict(_fields()),
)


def uncertainty_of(model: Any, robot: Robot) -> Mapping[str, Uncertainty]:
    """By parameter (m1, I1, ..., kappa2, h, psi_zero, phi_zero): as written, else the default."""
    standard = UncertaintyModel(**_DEFAULTS)
    found: dict[str, Uncertainty] = {}
    for number, platform in (("1", robot.platform1), ("2", robot.platform2)):
        for key in _UNITS:
            options = (
                getattr(model, f"{key}{number}"),
                getattr(model, key),
                getattr(standard, key),
            )
            spread = next(one for one in options if one is not None)
            found[f"{key}{number}"] = spread.of(getattr(platform, key))
    found["h"] = (model.h or standard.h).of(robot.h)
    for key in _ZEROS:
        if getattr(model, key) is not None:
            found[key] = getattr(model, key).of(0.0)
    return MappingProxyType(found)


def shares_of_nothing(model: Any, robot: Robot) -> Iterator[tuple[str, str]]:
    """Key and message of every share, or factor, of a value that is 0: it says nothing."""
    for key in model.model_fields_set:
        spread = getattr(model, key)
        name = key.rstrip("12")
        if name not in _UNITS or spread is None or spread.sigma:
            continue
        numbers = "12" if key == name else key[-1]
        zeros = [
            f"{name}{one}"
            for one in numbers
            if getattr(robot.platform1 if one == "1" else robot.platform2, name) == 0
        ]
        if zeros and (spread.relative or spread.factor):
            yield (
                key,
                f"The nominal {' and '.join(zeros)} is 0, and any share or multiple of it is 0: "
                "it would be taken as exact. Write an absolute value, such as "
                f"`{_EXAMPLES[_UNITS[name]]}`.",
            )


PLACE = Quantity("m", "40 mm")

Deviation = Annotated[float, Quantity("m", "1 mm", above=0)]
Turn = Annotated[float, Quantity("rad", "3 mrad", above=0)]
Torque = Annotated[float, Quantity("N m", "3 mN*m", above=0)]
Range = Annotated[float, Quantity("rad", "300 deg")]
CountOfZero = Annotated[float, Quantity("", "512")]
Counts = Annotated[int, Count(2, 1_000_000)]
Up = Literal["x", "y", "z", "-x", "-y", "-z"]


class NoiseModel(FileModel):
    """One standard deviation of the capture system."""

    position: Deviation = Field(description="Of x and y, m.")
    angle: Turn = Field(description="Of psi and phi, rad.")
    torque: Torque = Field(default=Noise.torque, description="Of the torque, N m.")


class CountScaleModel(FileModel):
    """What the counts of the servo's logs mean; without it those of the CDS5516."""

    counts: Counts = Field(default=CountScale.counts, description="How many counts there are.")
    range: Range = Field(
        default=CountScale.range,
        description="The angle they cover, rad; negative where phi falls as they rise.",
    )
    zero: CountOfZero = Field(default=CountScale.zero, description="The count at which phi = 0.")


class _PlacesSchema:
    """The JSON schema of a platform's markers."""

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        item = PLACE.json_schema()
        place = {"type": "array", "items": item, "minItems": 2, "maxItems": 3}
        return {"type": "object", "additionalProperties": place, "minProperties": 2}


Places = Annotated[dict[str, Any], SkipValidation, _PlacesSchema()]


class MarkersModel(FileModel):
    """Where the markers sit, each [forward, left] or [forward, left, up] from the joint P, m.

    Platform 1's forward axis points from P towards its axle, platform 2's from its axle towards P.
    """

    platform1: Places = Field(description="The markers of platform 1, by name, m.")
    platform2: Places = Field(description="The markers of platform 2, by name, m.")
    up: Up = Field(default="z", description="The axis of the capture frame that points up.")


class RecordingModel(FileModel):
    """One recording and how it was made."""

    file: str = Field(description="Its file, relative to this one.")
    gait: Annotated[str | SineRecord | FourierRecord | FreeRecord, SkipValidation] = Field(
        description="The commanded phi(t), its clock starting at the recording's t = 0; "
        "or the file of a result of rr-opt that holds it."
    )
    use: Use = Field(default="fit", description="holdout: kept back, to check the fit on.")
    start: Start = Field(
        default="running",
        description="rest: the robot stood still until t = 0, where the command began; running: "
        "the command began a whole number of periods earlier.",
    )
    servo_log: str | None = Field(
        default=None, description="The servo's own log of this run, relative to this file."
    )


class ExperimentModel(FileModel):
    """A robot as its builder believes it to be, and recordings of it in one floor frame."""

    robot: Annotated[str | RobotModel, SkipValidation] = Field(
        description="A robot file, relative to this one, or the robot itself: nominal values."
    )
    noise: NoiseModel = Field(description="How well the capture system sees.")
    uncertainty: UncertaintyModel = Field(  # pyright: ignore[reportInvalidTypeForm] - it is made
        default_factory=UncertaintyModel, description="How well nominal values are known."
    )
    recordings: Annotated[list[RecordingModel], SkipValidation] = Field(
        description="The recordings, each with the gait that was commanded.",
        json_schema_extra={"minItems": 1},
    )
    markers: Annotated[MarkersModel | None, SkipValidation] = Field(
        default=None, description="Where the markers sit; needed for marker files."
    )
    servo_counts: CountScaleModel = Field(
        default_factory=CountScaleModel, description="What the counts of servo logs mean."
    )
