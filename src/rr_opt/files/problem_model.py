"""The keys of problem and study files: their types, units, bounds and descriptions."""

from typing import Annotated, Any, Literal

from pydantic import Field, JsonValue, SkipValidation, WithJsonSchema, create_model

from rr_opt.files.fields import FileModel, Keys
from rr_opt.files.robot_file import RobotModel
from rr_opt.model.problem import (
    Direction,
    GaitBounds,
    Limits,
    Objective,
    RatioChoice,
    Shape,
    Spreads,
)

OWN_SHAPE: dict[str, Shape] = {"harmonics": "fourier", "intervals": "free"}
"""Keys of a gait that belong to one shape only."""


def _needs(key: str, shape: Shape) -> dict[str, Any]:
    """JSON Schema: where the key stands, the shape is this one."""
    then = {"properties": {"shape": {"const": shape}}, "required": ["shape"]}
    return {"if": {"required": [key]}, "then": then}


_GAIT = Keys(schema={"allOf": [_needs(key, shape) for key, shape in OWN_SHAPE.items()]})


class ProblemModel(FileModel):
    """Which gait drives the robot fastest? Plain numbers are SI; a text may carry a unit."""

    robot: Annotated[str | RobotModel | None, SkipValidation] = Field(
        default=None,
        description="A robot file, relative to this file, or the robot itself. "
        "Without it: the paper's prototype.",
    )
    gait: Annotated[GaitBounds, _GAIT] = Field(
        default_factory=GaitBounds, description="Which gaits are allowed."
    )
    inertia_ratio: Annotated[RatioChoice, Keys(alone="bounds")] | None = Field(
        default=None, description="J20/J10 as a choice. Without it: the robot as it is."
    )
    limits: Annotated[Limits, Keys()] = Field(
        default_factory=Limits,
        description="What a gait may ask of the robot. What is not given is what the robot's servo "
        "can do.",
    )
    direction: Direction = Field(default="either", description="Which way the robot shall go.")
    objective: Objective = Field(
        default="speed",
        description="What is best: the largest speed, or the least cost of transport.",
    )
    robust: Annotated[Spreads, Keys()] | None = Field(
        default=None,
        description="How well the robot is known. With it a gait is sought too that is fast on "
        "95 % of the robots that it may be.",
    )


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


_VALUES: JsonValue = {
    "type": "array",
    "minItems": 1,
    "description": "The values, one after another.",
}
_ONE: JsonValue = {"anyOf": [_VALUES, RangeModel.model_json_schema()]}
Varied = Annotated[
    dict[str, Any], SkipValidation, WithJsonSchema({"type": "object", "additionalProperties": _ONE})
]


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
    routes: list[str] | None = Field(
        default=None,
        min_length=1,
        description="Instead of all others: route files, relative to this file, each a case.",
    )
