"""The keys of a problem's `gait`: which gaits are allowed."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import ConfigDict, Field, JsonValue

from rr_opt.files.count import Count
from rr_opt.files.quantity import FixedOrBounded, Quantity
from rr_opt.files.robot_model import FileModel
from rr_opt.problem import GaitBounds, Interval, Shape

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
        default=None,
        description=f"Of a fourier gait; {GaitBounds.harmonics} if left out.",
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
