"""A field type of the file models: how many there are of something."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from rr_opt.files.issue import shown
from rr_opt.files.quantity import raising_value_error
from rr_opt.outcome import InputError


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
