"""The problem file's keys: their types, units, bounds and descriptions."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import (
    Field,
    GetJsonSchemaHandler,
    SkipValidation,
    model_validator,
)
from pydantic_core import CoreSchema

from rr_opt.files.gait_bounds_model import GaitModel
from rr_opt.files.quantity import FixedOrBounded, Quantity
from rr_opt.files.robot_model import ANGLE, RATE, TORQUE, FileModel, Length, Mass, RobotModel
from rr_opt.problem import Direction, Interval, Limits
from rr_opt.robot.ballast import About, By, Loads

RATIO = FixedOrBounded(Quantity("", "0.2", above=0))
Ratio = Annotated[Interval, RATIO]
OptionalAngle = Annotated[float | None, ANGLE]
OptionalRate = Annotated[float | None, RATE]
OptionalTorque = Annotated[float | None, TORQUE]
Distance = Annotated[float, Quantity("m", "44.1 mm", at_least=0)]


class LoadsModel(FileModel):
    """Loads that can be hung on platform 2."""

    mass: Mass = Field(default=Loads.mass, description="Mass of one load, kg.")
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
    singularity: Length = Field(
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
