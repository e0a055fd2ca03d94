"""The problem file's keys: their types, units, bounds and descriptions."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, SkipValidation, model_validator

from rr_opt.files.quantity import FixedOrBounded, Quantity
from rr_opt.files.robot_model import ANGLE, RATE, TORQUE, FileModel, Length, Mass, RobotModel
from rr_opt.problem import Direction, GaitBounds, Interval, Limits
from rr_opt.robot.ballast import About, By, Loads

Amplitude = Annotated[Interval, FixedOrBounded(Quantity("rad", "0.5", at_least=0))]
Period = Annotated[Interval, FixedOrBounded(Quantity("s", "1.2 s", above=0))]
Offset = Annotated[Interval, FixedOrBounded(Quantity("rad", "10 deg"))]
Ratio = Annotated[Interval, FixedOrBounded(Quantity("", "0.2", above=0))]
OptionalAngle = Annotated[float | None, ANGLE]
OptionalRate = Annotated[float | None, RATE]
OptionalTorque = Annotated[float | None, TORQUE]
Distance = Annotated[float, Quantity("m", "44.1 mm", at_least=0)]


def _bounds(default: Interval, description: str) -> Any:
    """A field with an interval for its default, which JSON Schema shows as a number or a pair."""
    written = default.low if default.fixed else [default.low, default.high]
    return Field(
        default_factory=lambda: default,
        description=f"{description} A number fixes it, a pair [low, high] bounds it.",
        json_schema_extra={"default": written},
    )


class GaitModel(FileModel):
    """phi(t) = amplitude sin(2 pi t/period) + offset."""

    shape: Literal["sine"] = Field("sine", description="The shape of phi(t).")
    amplitude: Amplitude = _bounds(GaitBounds.amplitude, "Amplitude, rad.")
    period: Period = _bounds(GaitBounds.period, "Period, s.")
    offset: Offset = _bounds(
        GaitBounds.offset, "Offset, rad: phi swings about it, and if it is not 0 the robot turns."
    )


class LoadsModel(FileModel):
    """Loads that can be hung on platform 2."""

    mass: Mass = Field(Loads.mass, description="Mass of one load, kg.")
    distance: Distance = Field(
        Loads.distance, description="From the joint P to the loads, towards the axle, m."
    )
    spread: Distance = Field(
        Loads.spread, description="Of the loads to either side of the platform's axis, m."
    )
    whole: bool = Field(Loads.whole, description="true: only whole numbers of loads exist.")


class InertiaRatioModel(FileModel):
    """J20/J10 as a choice. A number alone fixes it, about the joint, by platform 2's inertia."""

    bounds: Ratio = Field(
        description="J20/J10, dimensionless. A number fixes it, a pair [low, high] bounds it."
    )
    about: About = Field(
        "joint", description="The J are taken about the joint P, or each centre of mass."
    )
    by: By = Field("inertia", description="Realised by I of platform 2 alone, or by loads.")
    loads: LoadsModel = Field(
        default_factory=LoadsModel, description="The loads, if the ratio is realised by loads."
    )

    @model_validator(mode="before")
    @classmethod
    def _number_or_pair_alone(cls, value: Any) -> Any:
        return {"bounds": value} if isinstance(value, int | float | str | list) else value


class LimitsModel(FileModel):
    """What a gait may ask of the robot. What is not given is what the robot's servo can do."""

    angle: OptionalAngle = Field(None, description="Largest |phi|, rad, below pi.")
    rate: OptionalRate = Field(None, description="Largest |dphi/dt|, rad/s; .inf: no limit.")
    torque: OptionalTorque = Field(None, description="Largest |torque|, N m; .inf: no limit.")
    singularity: Length = Field(
        Limits.singularity, description="The least S1 = c1 cos phi + c2 allowed, m."
    )


class ProblemModel(FileModel):
    """Which gait drives the robot fastest? Plain numbers are SI; a text may carry a unit."""

    robot: Annotated[str | RobotModel | None, SkipValidation] = Field(
        None,
        description="A robot file, relative to this file, or the robot itself. "
        "Without it: the paper's prototype.",
    )
    gait: GaitModel = Field(default_factory=GaitModel, description="Which gaits are allowed.")
    inertia_ratio: InertiaRatioModel | None = Field(
        None, description="J20/J10 as a choice. Without it: the robot as it is."
    )
    limits: LimitsModel = Field(
        default_factory=LimitsModel, description="What a gait may ask of the robot."
    )
    direction: Direction = Field("either", description="Which way the robot shall go.")
