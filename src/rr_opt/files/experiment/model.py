"""The experiment file's keys: the robot, the capture system, and what was recorded."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, GetJsonSchemaHandler, SkipValidation
from pydantic_core import CoreSchema

from rr_opt.experiment.count_scale import CountScale
from rr_opt.experiment.experiment import Noise, Start, Use
from rr_opt.files.count import Count
from rr_opt.files.experiment.uncertainty import UncertaintyModel
from rr_opt.files.gait_model import FourierRecord, FreeRecord, SineRecord
from rr_opt.files.quantity import Quantity
from rr_opt.files.robot_model import FileModel, RobotModel

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
