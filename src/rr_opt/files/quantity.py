"""Field types of the file models: a quantity, and a quantity that may be fixed or bounded."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from rr_opt.files.issue import shown
from rr_opt.files.units import to_si
from rr_opt.outcome import InputError
from rr_opt.problem import Interval


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
