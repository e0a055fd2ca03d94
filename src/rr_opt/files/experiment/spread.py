"""A field type of the experiment file: how well a value is known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from rr_opt.experiment.experiment import Uncertainty
from rr_opt.files.issue import shown
from rr_opt.files.quantity import Quantity, raising_value_error
from rr_opt.files.units import to_si
from rr_opt.outcome import InputError

UNKNOWN = 5.0
"""What is `unknown` is free within this factor of its nominal value."""


@dataclass(frozen=True)
class Spread:
    """As written: sigma in SI, or relative to the nominal value, or unknown within a factor."""

    sigma: float = 0.0
    relative: float = 0.0
    factor: float | None = None

    def of(self, nominal: float) -> Uncertainty:
        """That of a value whose nominal is given."""
        return Uncertainty(self.sigma + self.relative * abs(nominal), self.factor)


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
                return Spread(factor=UNKNOWN)
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
