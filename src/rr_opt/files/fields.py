"""Field types of the file models, and what pydantic finds wrong with them, in plain English."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, GetCoreSchemaHandler, GetJsonSchemaHandler, ValidationError
from pydantic_core import CoreSchema, core_schema

from rr_opt.files.issue import Issue, one_of, shown, unknown_word
from rr_opt.files.units import to_si
from rr_opt.files.yaml_text import Document
from rr_opt.model.parameters import UNKNOWN_FACTOR, Spread
from rr_opt.model.problem import Interval
from rr_opt.outcome import InputError


@dataclass(frozen=True)
class Quantity:
    """Annotates a float that a file gives as a number in SI or as a text with its unit.

    unit      the SI unit, "" if it has none
    above     exclusive lower bound; at_least, at_most: inclusive; below: exclusive
    endless   `.inf` is allowed and means that there is no limit
    example   a text that a user could write
    """

    unit: str
    example: str
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    below: float | None = None
    endless: bool = False

    def read(self, value: object) -> float:
        """The value in `unit`. Raises InputError if it is not one, or out of its range."""
        try:
            number = to_si(value, self.unit)
        except InputError as error:
            raise InputError(f"{error} Write for example `{self.example}`.") from None
        inside = (
            (self.above is None or number > self.above)
            and (self.at_least is None or number >= self.at_least)
            and (self.at_most is None or number <= self.at_most)
            and (self.below is None or number < self.below)
            and (math.isfinite(number) or (self.endless and number > 0))
        )
        if not inside:
            known = "" if isinstance(value, int | float) else f", {number:.6g} {self.unit}".rstrip()
            raise InputError(
                f"Read {shown(value)}{known}. Expected {self.range_text()}. "
                f"Write for example `{self.example}`."
            )
        return number

    def range_text(self) -> str:
        """What is expected, in words."""
        parts = [
            f"{word} {bound:.6g}"
            for word, bound in (
                ("above", self.above),
                ("at least", self.at_least),
                ("at most", self.at_most),
                ("below", self.below),
            )
            if bound is not None
        ]
        kind = f"a number in {self.unit}" if self.unit else "a number"
        last = ", or .inf for no limit" if self.endless else ""
        return " ".join([kind, " and ".join(parts) or "that is finite"]) + last

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: a number within the range, or a text with a unit."""
        bounds = {
            "exclusiveMinimum": self.above,
            "minimum": self.at_least,
            "maximum": self.at_most,
            "exclusiveMaximum": self.below,
        }
        number = {"type": "number", **{k: v for k, v in bounds.items() if v is not None}}
        unit = self.unit or "dimensionless"
        text = {"type": "string", "description": f"a number with a unit of the kind {unit}"}
        return {"anyOf": [number, text], "examples": [self.example], "x-unit": unit}

    def __get_pydantic_core_schema__(self, _: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(raising_value_error(self.read))

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()


@dataclass(frozen=True)
class FixedOrBounded:
    """Annotates an Interval: a quantity fixes it, a pair [low, high] bounds it."""

    quantity: Quantity

    def read(self, value: object) -> Interval:
        """The interval in SI. Raises InputError."""
        if not isinstance(value, list):
            number = self.quantity.read(value)
            return Interval(number, number)
        if len(value) != 2:
            raise InputError(
                f"Read {shown(value)}, a list of {len(value)}. "
                "Expected one number, which fixes it, or a pair [low, high], which bounds it."
            )
        low, high = (self.quantity.read(item) for item in value)
        if low > high:
            raise InputError(
                f"Read {shown(value)}, whose low end is above its high end. "
                f"Write [{shown(value[1])}, {shown(value[0])}]."
            )
        return Interval(low, high)

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: what the quantity may be, or a list of two of them."""
        one = self.quantity.json_schema()
        pair = {"type": "array", "items": {"anyOf": one["anyOf"]}, "minItems": 2, "maxItems": 2}
        return {**one, "anyOf": [*one["anyOf"], pair]}

    def __get_pydantic_core_schema__(self, _: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(raising_value_error(self.read))

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()


def raising_value_error(read: Any) -> Any:
    """The same reader for pydantic, which gathers ValueErrors and lets every other error out."""

    def validate(value: object) -> Any:
        try:
            return read(value)
        except InputError as error:
            raise ValueError(str(error)) from None

    return validate


@dataclass(frozen=True)
class Count:
    """Annotates an int, or None where the key is left out: a whole number from least to most."""

    least: int
    most: int
    even: bool = False

    def read(self, value: object) -> int:
        """The number. Raises InputError."""
        if (
            isinstance(value, int)
            and not isinstance(value, bool)
            and self.least <= value <= self.most
            and not (self.even and value % 2)
        ):
            return value
        kind = "an even number" if self.even else "a whole number"
        raise InputError(
            f"Read {shown(value)}. Expected {kind} from {self.least} to {self.most}. "
            "Write it without a unit, or delete the key."
        )

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: an integer in the range."""
        step = {"multipleOf": 2} if self.even else {}
        return {"type": "integer", "minimum": self.least, "maximum": self.most, **step}

    def __get_pydantic_core_schema__(self, _: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(raising_value_error(self.read))

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.json_schema()


@dataclass(frozen=True)
class Uncertain:
    """Annotates a Spread: `2 mm`, `5 %`, `unknown`; a zero is only known absolutely."""

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
            return Spread(sigma=Quantity(self.unit, self.example, at_least=0).read(value))
        except InputError as error:
            other = "" if self.absolute else " A share such as `5 %`, or `unknown`, will do too."
            raise InputError(f"{error}{other}") from None

    def _share(self, value: str) -> float:
        share = to_si(value, "")
        if not 0 <= share < math.inf:
            raise InputError(f"Read {shown(value)}. Expected a share of at least 0. Write `5 %`.")
        return share

    def __get_pydantic_core_schema__(self, _: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(raising_value_error(self.read))

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        number = Quantity(self.unit, self.example, at_least=0).json_schema()
        return number if self.absolute else {**number, "examples": [self.example, "5 %", "unknown"]}


Model = TypeVar("Model", bound=BaseModel)

_EXPECTED = {
    "model_type": "keys with values under it",
    "model_attributes_type": "keys with values under it",
    "string_type": "a text",
    "bool_type": "true or false",
}


def validate(model: type[Model], document: Document) -> tuple[Model | None, list[Issue]]:
    """The document as a model, or None and every issue found."""
    try:
        return model.model_validate(document.data), []
    except ValidationError as error:
        found = error.errors(include_url=False)
        return None, [document.issue("error", one["loc"], _message(model, one)) for one in found]


def _message(model: type[BaseModel], found: Any) -> str:
    path, value, kind = found["loc"], found["input"], found["type"]
    owner = _model_at(model, path[:-1])
    if kind == "extra_forbidden":
        return unknown_word(str(path[-1]), list(owner.model_fields), "key")
    if kind == "missing":
        description = owner.model_fields[path[-1]].description
        return f"This key is missing. Add it. Expected: {description}"
    if kind == "value_error":
        return str(found["ctx"]["error"])
    if kind == "literal_error":
        choices = get_args(owner.model_fields[path[-1]].annotation)
        return (
            unknown_word(value, choices, "word")
            if isinstance(value, str)
            else (f"Read {shown(value)}. Expected {one_of(choices)}.")
        )
    if kind in _EXPECTED:
        return f"Read {shown(value)}. Expected {_EXPECTED[kind]}. Write it, or delete the key."
    return f"Read {shown(value)}. {found['msg']}."


def _model_at(model: type[BaseModel], path: tuple[str | int, ...]) -> type[BaseModel]:
    for key in path:
        annotation = model.model_fields[str(key)].annotation
        choices = get_args(annotation) or (annotation,)
        model = next(c for c in choices if isinstance(c, type) and issubclass(c, BaseModel))
    return model
