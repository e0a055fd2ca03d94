"""The robot file's keys: their types, units, bounds and descriptions."""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, GetJsonSchemaHandler, SkipValidation
from pydantic_core import CoreSchema

from rr_opt.files.quantity import Quantity
from rr_opt.robot.parameters import Servo

DEFAULT_WHEEL_RADIUS = 0.020
"""h where a robot file does not need one, m."""

Mass = Annotated[float, Quantity("kg", "469 g", above=0)]
Inertia = Annotated[float, Quantity("kg m^2", "0.00386", above=0)]
Length = Annotated[float, Quantity("m", "186 mm", above=0)]
SignedLength = Annotated[float, Quantity("m", "20 mm")]
OptionalLength = Annotated[float | None, Quantity("m", "20 mm", above=0)]
OptionalWheelFriction = Annotated[float | None, Quantity("N m s", "6.2e-5", at_least=0)]
OptionalFloorFriction = Annotated[float | None, Quantity("N s/m", "0.155", at_least=0)]

ANGLE = Quantity("rad", "2.6", above=0, below=math.pi)
RATE = Quantity("rad/s", "30 rpm", above=0, endless=True)
TORQUE = Quantity("N m", "14 kgf*cm", above=0, endless=True)
Angle = Annotated[float, ANGLE]
Rate = Annotated[float, RATE]
Torque = Annotated[float, TORQUE]


class FileModel(BaseModel):
    """Keys of a file: none other than those named, and nothing converted in silence."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class PlatformModel(FileModel):
    """One platform with its wheel pair. Give kappa or k, not both."""

    model_config = ConfigDict(
        json_schema_extra={"oneOf": [{"required": ["kappa"]}, {"required": ["k"]}]}
    )

    m: Mass = Field(description="Mass, kg.")
    I: Inertia = Field(
        description="Moment of inertia about the vertical through the centre of mass, kg m2."
    )
    c: Length = Field(description="Distance from the axle's centre to the joint P, m.")
    a: SignedLength = Field(
        description="Distance from the axle's centre to the centre of mass, towards P, m."
    )
    b: Length = Field(description="Half track: from the axle's centre to each wheel, m.")
    kappa: OptionalWheelFriction = Field(
        default=None, description="Viscous friction of one wheel about its axle, N m s."
    )
    k: OptionalFloorFriction = Field(
        default=None, description="Viscous friction of one wheel along the floor, kappa/h^2, N s/m."
    )


class ServoModel(FileModel):
    """What the servo can do."""

    angle_limit: Angle = Field(
        default=Servo.angle_limit, description="Largest |phi|, rad, below pi."
    )
    rate_limit: Rate = Field(
        default=Servo.rate_limit, description="Largest |dphi/dt|, rad/s; .inf: no limit."
    )
    torque_limit: Torque = Field(
        default=Servo.torque_limit, description="Largest |torque|, N m; .inf: no limit."
    )


class _EffectsSchema:
    """The JSON schema of `physics`, from the catalogue of effects."""

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        # Here and not above: the catalogue loads CasADi, and reading most files does not.
        from rr_opt.files.physics_section import effects_json_schema  # noqa: PLC0415

        return effects_json_schema()


class RobotModel(FileModel):
    """A Roller Racer. Plain numbers are SI; a text may carry a unit, such as 186 mm."""

    name: str = Field(default="", description="What people call this robot.")
    platform1: PlatformModel = Field(description="The platform whose heading is psi.")
    platform2: PlatformModel = Field(description="The platform that the servo turns by phi.")
    h: OptionalLength = Field(
        default=None,
        description="Wheel radius, m. Needed with kappa or physics; else 20 mm, without effect.",
    )
    servo: ServoModel = Field(default_factory=ServoModel, description="The servo's limits.")
    physics: Annotated[list[dict[str, Any]], SkipValidation, _EffectsSchema()] = Field(
        default_factory=list, description="Effects beyond the paper's model, by catalogue name."
    )
    provenance: Annotated[dict[str, Any], SkipValidation] = Field(
        default_factory=dict,
        description="Where values come from: the robot's keys again, each with a text that begins "
        "with measured, fitted or assumed.",
    )
