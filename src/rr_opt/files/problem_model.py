"""The keys of problem and study files: their types, units, bounds and descriptions."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import (
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    JsonValue,
    SkipValidation,
    create_model,
    model_validator,
)
from pydantic_core import CoreSchema

from rr_opt.files.fields import Count, FixedOrBounded, Quantity
from rr_opt.files.robot_file import ANGLE, RATE, TORQUE, FileModel, RobotModel
from rr_opt.model.ballast import About, By, Loads
from rr_opt.model.problem import Direction, GaitBounds, Interval, Limits, Shape

Amplitude = Annotated[Interval, FixedOrBounded(Quantity("rad", "0.5", at_least=0))]
Period = Annotated[Interval, FixedOrBounded(Quantity("s", "1.2 s", above=0))]
Offset = Annotated[Interval, FixedOrBounded(Quantity("rad", "10 deg"))]
Harmonics = Annotated[int | None, Count(1, 16)]
Intervals = Annotated[int | None, Count(16, 384, even=True)]

OWN_SHAPE: dict[str, Shape] = {"harmonics": "fourier", "intervals": "free"}
"""Keys of a gait that belong to one shape only."""


def _bounds(default: Interval, description: str) -> Any:
    """A field with an interval for its default, which JSON Schema shows as a number or a pair."""
    written: JsonValue = default.low if default.fixed else [default.low, default.high]
    return Field(
        default_factory=lambda: default,
        description=f"{description} A number fixes it, a pair [low, high] bounds it.",
        json_schema_extra={"default": written},
    )


def _needs(key: str, shape: Shape) -> dict[str, Any]:
    """JSON Schema: where the key stands, the shape is this one."""
    then = {"properties": {"shape": {"const": shape}}, "required": ["shape"]}
    return {"if": {"required": [key]}, "then": then}


class GaitModel(FileModel):
    """phi(t): a sine, amplitude sin(2 pi t/period) + offset, or a shape that is looked for too.

    A fourier or free gait has the mean angle offset, its first harmonic has at least the least
    amplitude, and it never leaves the offset by more than the largest: every sine within the
    bounds is allowed, and other shapes with it.
    """

    model_config = ConfigDict(
        json_schema_extra={"allOf": [_needs(key, shape) for key, shape in OWN_SHAPE.items()]}
    )

    shape: Shape = Field(
        default=GaitBounds.shape,
        description="The shape of phi(t): sine; fourier, of several harmonics; or free, with a "
        "constant acceleration on each of many intervals of the period.",
    )
    harmonics: Harmonics = Field(
        default=None, description=f"Of a fourier gait; {GaitBounds.harmonics} if left out."
    )
    intervals: Intervals = Field(
        default=None,
        description=f"Of a free gait, an even number; {GaitBounds.intervals} if left out.",
    )
    amplitude: Amplitude = _bounds(GaitBounds.amplitude, "Amplitude, rad.")
    period: Period = _bounds(GaitBounds.period, "Period, s.")
    offset: Offset = _bounds(
        GaitBounds.offset, "Offset, rad: phi swings about it, and if it is not 0 the robot turns."
    )


RATIO = FixedOrBounded(Quantity("", "0.2", above=0))
Ratio = Annotated[Interval, RATIO]
OptionalAngle = Annotated[float | None, ANGLE]
OptionalRate = Annotated[float | None, RATE]
OptionalTorque = Annotated[float | None, TORQUE]
Distance = Annotated[float, Quantity("m", "44.1 mm", at_least=0)]


class LoadsModel(FileModel):
    """Loads that can be hung on platform 2."""

    mass: Annotated[float, Quantity("kg", "66 g", above=0)] = Field(
        default=Loads.mass, description="Mass of one load, kg."
    )
    distance: Distance = Field(
        default=Loads.distance, description="From the joint P to the loads, towards the axle, m."
    )
    spread: Distance = Field(
        default=Loads.spread, description="Of the loads to either side of the platform's axis, m."
    )
    whole: bool = Field(default=Loads.whole, description="true: only whole numbers of loads exist.")


class InertiaRatioModel(FileModel):
    """J20/J10 as a choice. A number alone fixes it, about the joint, by platform 2's inertia."""

    bounds: Ratio = Field(
        description="J20/J10, dimensionless. A number fixes it, a pair [low, high] bounds it."
    )
    about: About = Field(
        default="joint", description="The J are taken about the joint P, or each centre of mass."
    )
    by: By = Field(default="inertia", description="Realised by I of platform 2 alone, or by loads.")
    loads: LoadsModel = Field(
        default_factory=LoadsModel, description="The loads, if the ratio is realised by loads."
    )

    @model_validator(mode="before")
    @classmethod
    def _number_or_pair_alone(cls, value: Any) -> Any:
        return {"bounds": value} if isinstance(value, int | float | str | list) else value


class _OrBoundsAlone:
    """The JSON schema of `inertia_ratio`, which may be its bounds alone."""

    def __get_pydantic_json_schema__(
        self, inner: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {"anyOf": [handler(inner), RATIO.json_schema()]}


class LimitsModel(FileModel):
    """What a gait may ask of the robot. What is not given is what the robot's servo can do."""

    angle: OptionalAngle = Field(default=None, description="Largest |phi|, rad, below pi.")
    rate: OptionalRate = Field(
        default=None, description="Largest |dphi/dt|, rad/s; .inf: no limit."
    )
    torque: OptionalTorque = Field(
        default=None, description="Largest |torque|, N m; .inf: no limit."
    )
    singularity: Annotated[float, Quantity("m", "20 mm", above=0)] = Field(
        default=Limits.singularity, description="The least S1 = c1 cos phi + c2 allowed, m."
    )


class ProblemModel(FileModel):
    """Which gait drives the robot fastest? Plain numbers are SI; a text may carry a unit."""

    robot: Annotated[str | RobotModel | None, SkipValidation] = Field(
        default=None,
        description="A robot file, relative to this file, or the robot itself. "
        "Without it: the paper's prototype.",
    )
    gait: GaitModel = Field(default_factory=GaitModel, description="Which gaits are allowed.")
    inertia_ratio: Annotated[InertiaRatioModel | None, _OrBoundsAlone()] = Field(
        default=None, description="J20/J10 as a choice. Without it: the robot as it is."
    )
    limits: LimitsModel = Field(
        default_factory=LimitsModel, description="What a gait may ask of the robot."
    )
    direction: Direction = Field(default="either", description="Which way the robot shall go.")


MOST_CASES = 100_000


def _number(description: str, **default: Any) -> Any:
    """A field read later, when the unit of its key is known."""
    kinds: list[JsonValue] = [{"type": "number"}, {"type": "string"}]
    return Field(description=description, json_schema_extra={"anyOf": kinds}, **default)


# `from` is no name that a class body can hold.
RangeModel: Any = create_model(
    "RangeModel",
    __base__=FileModel,
    __doc__="Values from one to another, both included. Give count or step, not both.",
    **{
        "from": (Any, _number("The first value, with its unit if it has one.")),
        "to": (Any, _number("The last value.")),
        "count": (
            Annotated[int, Field(ge=2, le=MOST_CASES)],
            Field(default=None, description="How many values."),
        ),
        "step": (Any, _number("From one value to the next.", default=None)),
        "spacing": (
            Literal["linear", "log"],
            Field(default="linear", description="log: each value is the last times a factor."),
        ),
    },
)


class _Varied:
    """The JSON schema of the values of a key: a list, or a range."""

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        values = {"type": "array", "minItems": 1, "description": "The values, one after another."}
        item = {"anyOf": [values, RangeModel.model_json_schema()]}
        return {"type": "object", "additionalProperties": item}


Varied = Annotated[dict[str, Any], SkipValidation, _Varied()]


class StudyModel(FileModel):
    """A problem solved again and again with other values of some of its keys.

    A key is named by its path in the problem file, `limits.rate` or `robot.platform2.I`, an entry
    of a list by its index, `robot.physics[0].force1` or `gait.period[1]`.
    """

    problem: Annotated[str | ProblemModel | None, SkipValidation] = Field(
        default=None,
        description="A problem file, relative to this file, or the problem itself. "
        "Without it: the paper's prototype.",
    )
    vary: Varied = Field(
        default_factory=dict,
        description="Keys of the problem, each with a list or a range of values. "
        "Every combination is a case.",
    )
    together: list[Varied] = Field(
        default_factory=list,
        description="Groups of keys whose values, as many for each key, are taken in step.",
    )
