"""The keys of a gait's record, for each shape: their types, units, bounds and descriptions."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from rr_opt.files.issue import shown
from rr_opt.files.quantity import Quantity, raising_value_error
from rr_opt.files.robot_model import FileModel
from rr_opt.outcome import InputError

MOST_NUMBERS = 10_000
"""Longer lists than any gait has are refused unread."""


class Numbers:
    """Annotates a tuple of floats that a file gives as a list of quantities."""

    def __init__(self, unit: str, least: int):
        self.quantity = Quantity(unit, "0.1")
        self.least = least

    def read(self, value: object) -> tuple[float, ...]:
        """The numbers in SI. Raises InputError, which names the first that is wrong."""
        unit = self.quantity.unit
        if not isinstance(value, list) or not self.least <= len(value) <= MOST_NUMBERS:
            got = f"a list of {len(value)}" if isinstance(value, list) else shown(value)
            raise InputError(
                f"Read {got}. Expected a list of at least {self.least} numbers in {unit}. "
                "Take the gait from a result that rr-opt wrote."
            )
        return tuple(self._one(number, item) for number, item in enumerate(value, 1))

    def _one(self, number: int, item: object) -> float:
        try:
            return self.quantity.read(item)
        except InputError as error:
            raise InputError(f"Number {number} of the list: {error}") from None

    def __get_pydantic_core_schema__(self, _: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(raising_value_error(self.read))


Angle = Annotated[float, Quantity("rad", "0.5")]
Size = Annotated[float, Quantity("rad", "0.5", at_least=0)]
OptionalAngle = Annotated[float | None, Quantity("rad", "0.5")]
OptionalSize = Annotated[float | None, Quantity("rad", "0.5", at_least=0)]
Duration = Annotated[float, Quantity("s", "1.2 s", above=0)]
Rate = Annotated[float, Quantity("rad/s", "1.5")]


class SineRecord(FileModel):
    """phi(t) = amplitude sin(2 pi t/period) + offset."""

    shape: Literal["sine"] = Field(default="sine", description="`sine`")
    amplitude: Size = Field(description="amplitude, rad.")
    period: Duration = Field(description="period, s.")
    offset: Angle = Field(description="offset, rad.")


class FourierRecord(FileModel):
    """phi(t) = offset + sum of sines[n-1] sin(2 pi n t/period) + cosines[n-1] cos(2 pi n t/period).

    The amplitude says no more than the sines and cosines do.
    """

    shape: Literal["fourier"] = Field(description="`fourier`")
    amplitude: OptionalSize = Field(default=None, description="largest |phi - offset|, rad.")
    period: Duration = Field(description="period, s.")
    offset: Angle = Field(description="offset, rad.")
    sines: Annotated[tuple[float, ...], Numbers("rad", 1)] = Field(
        description="the sizes of the sines, rad, one for each harmonic."
    )
    cosines: Annotated[tuple[float, ...], Numbers("rad", 1)] = Field(
        description="the sizes of the cosines, rad, one for each harmonic."
    )


class FreeRecord(FileModel):
    """phi(t) with a constant acceleration on each of many equal intervals of the period.

    Amplitude and offset say no more than the other values do.
    """

    shape: Literal["free"] = Field(description="`free`")
    amplitude: OptionalSize = Field(default=None, description="largest |phi - offset|, rad.")
    period: Duration = Field(description="period, s.")
    offset: OptionalAngle = Field(default=None, description="mean of phi, rad.")
    angle0: Angle = Field(description="phi at the start, rad.")
    rate0: Rate = Field(description="dphi/dt at the start, rad/s.")
    accelerations: Annotated[tuple[float, ...], Numbers("rad/s^2", 2)] = Field(
        description="d2phi/dt2 on each interval, rad/s2."
    )
