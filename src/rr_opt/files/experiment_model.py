"""The experiment file's keys: the robot, the capture system, and what was recorded."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, SkipValidation

from rr_opt.files.fields import FileModel, Key, Keys, optional, section
from rr_opt.files.record import FourierRecord, FreeRecord, SineRecord
from rr_opt.files.robot_file import RobotModel
from rr_opt.messages import shown, unknown_word
from rr_opt.model.experiment import UNITS, Column, CountScale, Noise, Start, Use
from rr_opt.model.fields import Count
from rr_opt.model.parameters import (
    PARAMETERS,
    PLATFORM_SYMBOLS,
    SYMBOLS,
    UNKNOWN_FACTOR,
    Spread,
    Uncertainty,
    parameters_of,
)
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_opt.units import Number, to_si

_ZEROS = ("psi_zero", "phi_zero")


def _fields() -> Iterator[tuple[str, Any]]:
    for symbol, one in SYMBOLS.items():
        meant = one.plural if symbol in PLATFORM_SYMBOLS else one.words
        default = f"One sigma of the {meant}, {one.unit}. Default: {one.uncertainty}."
        yield symbol, optional(Uncertain(one.unit, one.sigma_example), default)
    for name, one in PARAMETERS.items():
        if one.platform:
            meant = f"One sigma of platform {one.platform}'s {one.symbol}, {one.unit}."
            yield name, optional(Uncertain(one.unit, one.sigma_example), meant)
    for key in _ZEROS:
        meant = f"One sigma of the zero of {key[:3]}, rad; else exact."
        yield key, optional(Uncertain("rad", "5 mrad", absolute=True), meant)


@dataclass(frozen=True)
class Uncertain:
    """Reads a Spread: `2 mm`, `5 %`, `unknown`; a zero of the capture system only absolutely."""

    unit: str
    example: str
    absolute: bool = False

    def read(self, value: object) -> Spread:
        """The spread. Raises InputError."""
        if not self.absolute and isinstance(value, str):
            if value.strip() == "unknown":
                return Spread(factor=UNKNOWN_FACTOR)
            if value.strip().endswith("%"):
                return Spread(relative=self._share(value))
        try:
            return Spread(sigma=Number(self.unit, self.example, at_least=0).read(value))
        except InputError as error:
            other = "" if self.absolute else " A share such as `5 %`, or `unknown`, is allowed too."
            raise InputError(f"{error}{other}") from None

    def _share(self, value: str) -> float:
        share = to_si(value, "")
        if not 0 <= share < math.inf:
            raise InputError(f"Read {shown(value)}. Expected a share of at least 0. Write `5 %`.")
        return share

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: an absolute uncertainty, or other text."""
        number = Number(self.unit, self.example, at_least=0).json_schema()
        return number if self.absolute else {**number, "examples": [self.example, "5 %", "unknown"]}


UncertaintyModel = section(
    "UncertaintyModel",
    "How well nominal values are known: `2 mm`, `5 %`, or `unknown`, free within a factor of 5. "
    "`m` stands for `m1` and `m2`, which take precedence; 0 is exact.",
    dict(_fields()),
)


def uncertainty_of(model: Any, robot: Robot) -> Mapping[str, Uncertainty]:
    """By parameter (m1, I1, ..., kappa2, h, psi_zero, phi_zero): as written, else the default."""
    found: dict[str, Uncertainty] = {}
    for name, value in parameters_of(robot).items():
        parameter = PARAMETERS[name]
        given = getattr(model, name), getattr(model, parameter.symbol), parameter.uncertainty
        found[name] = next(spread for spread in given if spread is not None).of(value)
    for key in _ZEROS:
        if getattr(model, key) is not None:
            found[key] = getattr(model, key).of(0.0)
    return MappingProxyType(found)


def shares_of_nothing(model: Any, robot: Robot) -> Iterator[tuple[str, str]]:
    """Key and message of every relative uncertainty of a value that is 0, which means nothing."""
    values = parameters_of(robot)
    for key in model.model_fields_set:
        spread = getattr(model, key)
        if spread is None or not spread.relative:
            continue
        names = [one.name for one in PARAMETERS.values() if key in (one.name, one.symbol)]
        zeros = [name for name in names if values[name] == 0]
        if zeros:
            yield (
                key,
                f"The nominal {' and '.join(zeros)} is 0, and so is any share of it: "
                "it would be taken as exact. Write an absolute value, such as "
                f"`{PARAMETERS[zeros[0]].sigma_example}`.",
            )


@dataclass(frozen=True)
class ColumnOf:
    """Reads a Column: its name, or a mapping with name, factor and bits; unit: of the channel."""

    unit: str

    def read(self, value: object) -> Column:
        """The column. Raises InputError."""
        given = value if isinstance(value, dict) else {"column": value}
        for key in given:
            if key not in _COLUMN:
                raise InputError(unknown_word(str(key), _COLUMN, "key"))
        name, bits = given.get("column"), given.get("bits")
        if not isinstance(name, str) or not name.strip():
            raise InputError(
                f"Read {shown(name)}. Expected the name of a column. Write for example "
                "`psi: theta`, or `{column: theta, factor: 1 deg}`."
            )
        factor = self._factor.read(given.get("factor", 1))
        return Column(name, factor, None if bits is None else _BITS.read(bits))

    @property
    def _factor(self) -> Number:
        return Number(self.unit, f"0.001 {self.unit}".strip())

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: a name, or a mapping."""
        keys = {
            "column": {"type": "string", "minLength": 1},
            "factor": {**self._factor.json_schema(), "description": "What 1 in the column is."},
            "bits": {**_BITS.json_schema(), "description": "Bits of a count with a sign."},
        }
        whole = {"type": "object", "properties": keys, "required": ["column"]}
        return {"anyOf": [keys["column"], {**whole, "additionalProperties": False}]}


_COLUMN = ("column", "factor", "bits")
_BITS = Count(2, 64)


ColumnsModel = section(
    "ColumnsModel",
    "Columns and units of the channels in text files that name them differently.",
    {
        name: optional(ColumnOf(unit), f"Where {name}{f' ({unit})' if unit else ''} is.")
        for name, unit in {**UNITS, "goal": "", "present": ""}.items()
    },
)

Up = Literal["x", "y", "z", "-x", "-y", "-z"]


class Place:
    """Reads the place of a marker: [forward, left] or [forward, left, up], m."""

    size = Number("m", "40 mm")

    def read(self, value: object) -> tuple[float, ...]:
        """The place. Raises InputError."""
        if not isinstance(value, list) or len(value) not in (2, 3):
            raise InputError(
                f"Read {shown(value)}. Expected [forward, left] or [forward, left, up] from the "
                "joint P, in m. Write for example `[40 mm, 0]`."
            )
        return tuple(self.size.read(item) for item in value)

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: an array of lengths."""
        item = self.size.json_schema()
        return {"type": "array", "items": item, "minItems": 2, "maxItems": 3}


def _two_markers(given: object) -> object:
    if isinstance(given, dict) and len(given) > 1:
        return given
    raise ValueError(
        f"Read {shown(given)}. Expected at least 2 markers by name: a single one has no heading. "
        "Write for example `{RR1: [40 mm, 0], RR2: [180 mm, 30 mm]}`."
    )


Places = Annotated[
    dict[str, Annotated[Any, Key(Place())]], Field(min_length=2), BeforeValidator(_two_markers)
]


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
        "or the file of a result of rr-opt that has it."
    )
    use: Use = Field(default="fit", description="holdout: kept back to check the fit.")
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

    machine: Literal["racer"] = Field(
        default="racer", description="What was recorded: the Roller Racer. Others have other keys."
    )
    robot: Annotated[str | RobotModel, SkipValidation] = Field(
        description="A robot file, relative to this one, or the robot itself: nominal values."
    )
    noise: Annotated[Noise, Keys()] = Field(description="Noise of the capture system.")
    uncertainty: UncertaintyModel = Field(  # pyright: ignore[reportInvalidTypeForm] - it is made
        default_factory=UncertaintyModel, description="How well nominal values are known."
    )
    recordings: Annotated[list[RecordingModel], SkipValidation] = Field(
        description="The recordings, each with the gait that was commanded.",
        json_schema_extra={"minItems": 1},
    )
    markers: Annotated[MarkersModel | None, SkipValidation] = Field(
        default=None,
        description="Where the markers sit; otherwise estimated from the recordings, in which the "
        "robot has to drive while its joint moves.",
    )
    columns: ColumnsModel = Field(  # pyright: ignore[reportInvalidTypeForm] - it is made
        default_factory=ColumnsModel, description="Columns of text files with other names or units."
    )
    servo_counts: Annotated[CountScale, Keys()] = Field(
        default_factory=CountScale, description="The scale of the counts in servo logs."
    )
