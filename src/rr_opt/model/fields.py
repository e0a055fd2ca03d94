"""Fields that declare their unit and range once, and accept text with a unit.

    @data
    class Servo:
        rate_limit: SI = declared(Quantity("rad/s", "30 rpm", above=0), "Largest |dphi/dt|, rad/s.")

`Servo(rate_limit="30 rpm")` then holds pi. Numbers are in SI and taken as they are; text is read
and checked against the range. The keys of files and their schemas come from the same declarations.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import MISSING, dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar, dataclass_transform

import numpy as np

from rr_opt.messages import shown
from rr_opt.outcome import InputError
from rr_opt.units import Number


@dataclass(frozen=True)
class Interval:
    """A closed interval; `low == high` fixes the quantity."""

    low: float
    high: float

    @property
    def fixed(self) -> bool:
        """Both ends are equal."""
        return self.low == self.high

    def clip(self, value: float) -> float:
        """The number of the interval that is nearest to value."""
        return min(max(value, self.low), self.high)


@dataclass(frozen=True)
class Range:
    """An interval of a quantity: a value fixes it, a pair (low, high) bounds it."""

    quantity: Number

    def is_read(self, value: object) -> bool:
        """Whether the value is an interval already."""
        return type(value) is Interval

    def read(self, value: object) -> Interval:
        """The interval in SI. Raises InputError."""
        if not isinstance(value, list | tuple):
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


@dataclass(frozen=True)
class Series:
    """A sequence of numbers of one quantity, with a least length."""

    quantity: Number
    least: int = 1

    def is_read(self, value: Any) -> bool:
        """Whether the value is a tuple of numbers already."""
        return type(value) is tuple and str not in map(type, value)

    def read(self, value: object) -> tuple[float, ...]:
        """The numbers in SI. Raises InputError, which names the first that is wrong."""
        value = value.tolist() if isinstance(value, np.ndarray) else value
        if not isinstance(value, list | tuple) or not self.least <= len(value) <= _MOST_NUMBERS:
            got = f"a list of {len(value)}" if isinstance(value, list | tuple) else shown(value)
            raise InputError(
                f"Read {got}. Expected a list of at least {self.least} numbers in "
                f"{self.quantity.unit}. Take the gait from a result that rr-opt wrote."
            )
        return tuple(self._one(number, item) for number, item in enumerate(value, 1))

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: a list of what the quantity may be."""
        items = {"anyOf": self.quantity.json_schema()["anyOf"]}
        return {"type": "array", "items": items, "minItems": self.least}

    def _one(self, number: int, item: object) -> float:
        try:
            return self.quantity.read(item)
        except InputError as error:
            raise InputError(f"Number {number} of the list: {error}") from None


_MOST_NUMBERS = 10_000
"""Longer lists than any gait has are refused unread."""


@dataclass(frozen=True)
class Count:
    """An integer from least to most."""

    least: int
    most: int
    even: bool = False

    def is_read(self, value: object) -> bool:
        """Whether the value is an integer already."""
        return type(value) is int

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


Reader = Number | Range | Series | Count

if TYPE_CHECKING:
    # What a type checker is to see: each accepts more when a dataclass is made than it holds.

    class SI(float):
        """A float in SI; also given as text with its unit."""

        def __get__(self, obj: object, owner: Any) -> float: ...
        def __set__(self, obj: object, value: float | str) -> None: ...

    class OptionalSI(float):
        """The same, or None for a value that follows from elsewhere."""

        def __get__(self, obj: object, owner: Any) -> float: ...
        def __set__(self, obj: object, value: float | str | None) -> None: ...

    class Bounds(Interval):
        """An Interval in SI; also given as one value, or as a pair (low, high)."""

        def __get__(self, obj: object, owner: Any) -> Interval: ...
        def __set__(
            self, obj: object, value: Interval | float | str | tuple[float | str, float | str]
        ) -> None: ...

    class Numbers(tuple[float, ...]):
        """A tuple of floats in SI; also given as a sequence of numbers or text with units."""

        def __get__(self, obj: object, owner: Any) -> tuple[float, ...]: ...
        def __set__(self, obj: object, value: Sequence[float | str]) -> None: ...

else:
    SI = OptionalSI = float
    Bounds = Interval
    Numbers = tuple[float, ...]


def declared(reader: Reader | None, description: str, *, default: Any = MISSING) -> Any:
    """A field of a class made by `data`; the description names the unit.

    Without a reader the value is of the annotated type, such as bool.
    """
    return field(default=default, metadata={"reader": reader, "description": description})


Class = TypeVar("Class")


@dataclass_transform(frozen_default=True, field_specifiers=(field, declared))
def data(cls: type[Class]) -> type[Class]:
    """A frozen dataclass whose declared fields may be given as text with units.

    Raises InputError, naming class and field, for text that is not such a quantity.
    """
    scalars: list[tuple[str, Number]] = []
    others: list[tuple[str, Range | Series | Count]] = []
    then: Callable[[Any], None] | None = getattr(cls, "__post_init__", None)

    def convert(self: Any, name: str, reader: Reader) -> None:
        try:
            # The class is frozen.
            object.__setattr__(self, name, reader.read(self.__dict__[name]))
        except InputError as error:
            raise InputError(f"{cls.__name__}.{name}: {error}") from None

    def __post_init__(self: Any) -> None:  # noqa: N807 - dataclass calls it by this name
        values = self.__dict__
        # Numerical loops make many of these objects, all of floats: a type test is all they pay.
        for name, reader in scalars:
            if type(values[name]) is str:
                convert(self, name, reader)
        for name, reader in others:
            if not reader.is_read(values[name]):
                convert(self, name, reader)
        if then:
            then(self)

    cls.__post_init__ = __post_init__  # pyright: ignore[reportAttributeAccessIssue]
    made = dataclass(frozen=True)(cls)
    declarations: Any = dataclasses.fields(made)  # pyright: ignore[reportArgumentType]
    for one in declarations:
        reader = one.metadata.get("reader")
        if isinstance(reader, Number):
            scalars.append((one.name, reader))
        elif reader:
            others.append((one.name, reader))
    return made
