"""A gait as the mapping that a result holds, and such a mapping back to the gait.

`shape`, `amplitude`, `period` and `offset` are always there; a fourier gait adds `sines` and
`cosines`, a free gait `angle0`, `rate0` and `accelerations`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import Field, GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from rr_opt.files.fields import Quantity, raising_value_error, validate
from rr_opt.files.issue import Issue, shown, unknown_word
from rr_opt.files.robot_file import FileModel
from rr_opt.files.yaml_text import Document
from rr_opt.model.gait import FourierGait, FreeGait, Gait, SineGait
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


_MODELS = {"sine": SineRecord, "fourier": FourierRecord, "free": FreeRecord}

_ROUNDING = 1e-6
"""What a record that was written by a program may be off by, relative to the gait's size."""


def gait_record(gait: Gait) -> dict[str, Any]:
    """The gait in SI, complete: `gait_from` makes the same gait of it, to the last digit."""
    record: dict[str, Any] = {
        "shape": gait.shape,
        "amplitude": gait.amplitude,
        "period": gait.period,
        "offset": gait.offset,
    }
    if isinstance(gait, FourierGait):
        record |= {"sines": list(gait.sines), "cosines": list(gait.cosines)}
    elif isinstance(gait, FreeGait):
        record |= {
            "angle0": gait.angle0,
            "rate0": gait.rate0,
            "accelerations": list(gait.accelerations),
        }
    return record


def gait_from(document: Document) -> tuple[Gait | None, list[Issue]]:
    """The gait that a mapping describes (None if there are issues), and all issues."""
    shape = document.data.get("shape", "sine")
    if not isinstance(shape, str):
        message = f"Read {shown(shape)}. Expected one of: {', '.join(_MODELS)}."
        return None, [document.issue("error", ("shape",), message)]
    if shape not in _MODELS:
        message = unknown_word(shape, list(_MODELS), "word")
        return None, [document.issue("error", ("shape",), message)]
    model, issues = validate(_MODELS[shape], document)
    if isinstance(model, SineRecord):
        return SineGait(model.amplitude, model.period, model.offset), issues
    if isinstance(model, FourierRecord):
        if len(model.sines) != len(model.cosines):
            message = (
                f"Read {len(model.cosines)} cosines and {len(model.sines)} sines. Expected as "
                "many of each. Write 0 for those that are missing."
            )
            return None, [document.issue("error", ("cosines",), message)]
        gait = FourierGait(model.period, model.offset, model.sines, model.cosines)
    elif isinstance(model, FreeRecord):
        gait = FreeGait(model.period, model.angle0, model.rate0, model.accelerations)
        issues = [document.issue("error", key, text) for key, text in _open_ends(gait)]
    else:
        return None, issues
    issues += [document.issue("error", key, text) for key, text in _disagreements(gait, model)]
    return (None if issues else gait), issues


def _open_ends(gait: FreeGait) -> Iterator[tuple[tuple[str, ...], str]]:
    """Where the values of a free gait do not come back to where they began."""
    ends = zip(("angle", "rate"), gait.nodes, ("rad", "rad/s"), strict=True)
    for what, values, unit in ends:
        gap = float(values[-1] - values[0])
        if not abs(gap) <= _ROUNDING * (1 + abs(values).max()):
            yield (
                ("accelerations",),
                f"After a period the {what} is {gap:.3g} {unit} from where it began. Expected it "
                "to come back, so that the gait can be repeated. Correct rate0 or accelerations.",
            )


def _disagreements(
    gait: FourierGait | FreeGait, model: FourierRecord | FreeRecord
) -> Iterator[tuple[tuple[str, ...], str]]:
    """Where what follows from the other values is given, and says something else."""
    if gait.amplitude == 0:
        yield (
            ("amplitude",),
            "Read a gait that does not move the servo. Expected one that does: its values make "
            "an amplitude of 0. Correct them.",
        )
    for key in ("amplitude", "offset"):
        given, made = getattr(model, key), getattr(gait, key)
        if given is not None and not abs(given - made) <= _ROUNDING * (1 + gait.peak_angle):
            yield (
                (key,),
                f"Read {given:.6g} rad. Expected {made:.6g} rad, which is what the gait's other "
                f"values make. Correct them, or delete {key}.",
            )
