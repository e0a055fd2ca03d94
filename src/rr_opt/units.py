"""Numbers with units, such as `30 rpm`, to SI.

Common units are in a table; pint knows the others, and is loaded only when needed. It never sees
the text itself: the text is split here into names and small integer powers, so a hostile
expression such as `9**9**9**9` is rejected, not computed.

Angles are distinguished from plain numbers: 30 Hz is not 30 rad/s, and 5 % is not an angle.
"""

import math
import operator
import re
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from rr_opt.messages import nearest, shown
from rr_opt.outcome import InputError

_KINDS = {
    "": "a plain number",
    "m": "a length",
    "m^2": "an area",
    "s": "a time",
    "1/s": "a frequency",
    "kg": "a mass",
    "rad": "an angle",
    "rad/s": "an angular rate",
    "m/s": "a speed",
    "m/s^2": "an acceleration",
    "kg m/s^2": "a force",
    "kg m^2/s^2": "a torque",
    "kg m^2": "a moment of inertia",
    "kg m^2/s": "a torque per angular rate",
    "kg/s": "a force per speed",
}
"""The dimension of each base unit."""

LARGEST = 1e30
"""Larger quantities are rejected, in any unit: their products would overflow."""

_LONGEST = 60
"""Longest text read as a number with a unit, characters."""

_NUMBER = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*)", re.DOTALL)
_TOKEN = re.compile(
    r"(?P<name>[A-Za-zµμΩ°%]+)(?:(?:\*\*|\^)?(?P<power>-?[1-9])(?![0-9.])|(?P<script>[²³]))?"
    r"|(?P<sign>[*·/()1])|\s+"
)
_SPELLINGS = {"Nm": "N m", "Nms": "N m s", "Ns": "N s", "RPM": "rpm", "°": "deg", "Nmm": "N mm"}
_COMMON = {
    "m": (1.0, "m"),
    "cm": (0.01, "m"),
    "mm": (0.001, "m"),
    "kg": (1.0, "kg"),
    "g": (0.001, "kg"),
    "s": (1.0, "s"),
    "ms": (0.001, "s"),
    "min": (60.0, "s"),
    "rad": (1.0, "rad"),
    "deg": (math.pi / 180, "rad"),
    "mrad": (0.001, "rad"),
    "rpm": (math.pi / 30, "rad/s"),
    "N": (1.0, "kg m/s^2"),
    "kgf": (9.80665, "kg m/s^2"),
    "Hz": (1.0, "1/s"),
    "%": (0.01, ""),
}
"""The value of one in base units, and those."""
# Rotational stiffness and damping may also be written per radian.
_ALSO = {"N m s": ("N m s/rad",), "N m": ("N m/rad",)}


def to_si(value: object, unit: str) -> float:
    """The value in `unit`, an SI unit such as `rad/s`; "" is dimensionless.

    A plain number is in `unit` already, and may be infinite. Raises InputError for anything that is
    not a number of that dimension.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise InputError(f"Read {shown(value)}. Expected {_wanted(unit)}.")
    if isinstance(value, str):
        number, written = _split(value, unit)
        value = number * _worth(written, unit, value) if written else number
        if math.isinf(value):
            raise InputError(f"Read a number that is too large. Expected {_wanted(unit)}.")
    try:
        result = float(value)
    except OverflowError:
        raise InputError(f"Read a number that is too large. Expected {_wanted(unit)}.") from None
    if math.isnan(result):
        raise InputError(f"Read `.nan`, not a number. Expected {_wanted(unit)}.")
    return result


def _wanted(unit: str) -> str:
    return f"a number, or a number with a unit, in {unit}" if unit else "a number without a unit"


def _split(text: str, unit: str) -> tuple[float, str]:
    match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None:
        raise InputError(f"Read the text {shown(text)}. Expected {_wanted(unit)}.")
    return float(match[1]), match[2].strip()


def unit_written(text: str) -> str:
    """The unit of a text such as `30 rpm`; empty if it has none, or no number."""
    match = _QUANTITY.fullmatch(text) if len(text) <= _LONGEST else None
    return match[2].strip() if match else ""


class _UnitError(ValueError):
    """The text after the number is not a unit; says why."""


def _worth(written: str, unit: str, text: str) -> float:
    """How many `unit` make one `written`."""
    try:
        factor, dimension = _base(written)
    except _UnitError as error:
        raise InputError(f"Read {shown(text)}. {error} Expected {_wanted(unit)}.") from None
    for accepted in (unit, *_ALSO.get(unit, ())):
        expected_factor, expected = _base(accepted)
        if dimension == expected:
            return factor / expected_factor
    kinds = (kind for base, kind in _KINDS.items() if dimension == _base(base)[1])
    what = next(kinds, "another kind of quantity")
    advice = ""
    if unit == "rad/s" and dimension == _base("Hz")[1]:
        advice = " Turns per second or radians per second? Write rpm, rad/s or deg/s."
    raise InputError(f"Read {shown(text)}, {what}. Expected {_wanted(unit)}.{advice}")


@lru_cache
def _registry() -> Any:
    # Loading takes a third of a second, and more for dask arrays, which it would load to recognise.
    absent = "dask" not in sys.modules
    if absent:
        sys.modules["dask"] = None  # type: ignore[assignment]
    try:
        import pint
    finally:
        if absent:
            del sys.modules["dask"]
    return pint.UnitRegistry()


@lru_cache(maxsize=256)
def _base(written: str) -> tuple[float, frozenset[tuple[str, int]]]:
    """The value of one `written` in base units, and their powers."""
    worth, powers = 1.0, Counter[str]()
    for name, power in _factors(written):
        factor, base = _COMMON.get(name) or _rare(name)
        worth *= factor**power
        for part, own in _factors(base):
            powers[part] += own * power
    return worth, frozenset((part, power) for part, power in powers.items() if power)


def _rare(name: str) -> tuple[float, str]:
    """The value of one in base units, and those, according to pint."""
    registry = _registry()
    try:
        unit = registry.parse_units(name)
        # Zero degrees Celsius or decibel is not zero: such scales have no factor.
        if registry.Quantity(0.0, unit).to_base_units().magnitude == 0.0:
            factor, base = registry.get_base_units(unit)
            return float(factor), f"{base:~C}"
    except (AttributeError, ValueError, TypeError):
        pass
    near = nearest(name, list(_COMMON))
    advice = f" Did you mean `{near}`?" if near else ""
    raise _UnitError(f"The unit {shown(name)} is not known.{advice}")


def _factors(written: str) -> list[tuple[str, int]]:
    """`kg m^2/(N s)` -> [(kg, 1), (m, 2), (N, -1), (s, -1)]."""
    for spelling, meant in _SPELLINGS.items():
        written = re.sub(rf"(?<![A-Za-z]){spelling}(?![A-Za-z])", meant, written)
    factors: list[tuple[str, int]] = []
    signs, sign, position = [1], 1, 0
    while position < len(written) and signs:
        token = _TOKEN.match(written, position)
        if token is None:
            break
        position = token.end()
        if token["name"]:
            script = {"²": 2, "³": 3}.get(token["script"], 1)
            power = int(token["power"]) if token["power"] else script
            factors.append((token["name"], power * signs[-1] * sign))
        elif token["sign"] == "(":
            signs.append(signs[-1] * sign)
        elif token["sign"] == ")":
            signs.pop()
        if token["sign"] != "1" and token[0].strip():
            sign = -1 if token["sign"] == "/" else 1
    nothing = (written and not factors) or re.search(r"\(\s*\)", written)
    if position < len(written) or len(signs) != 1 or sign != 1 or nothing:
        raise _UnitError(
            "Its unit cannot be understood; units look like `kg m^2`, `N*s/m` or `rpm`."
        )
    return factors


@dataclass(frozen=True)
class Number:
    """A number with its unit and range, as a file or a caller may give it.

    unit      the SI unit, "" if it has none
    above     exclusive lower bound; at_least, at_most: inclusive; below: exclusive
    endless   `.inf` is allowed and means no limit
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
        inside = all(holds(number, bound) for _, _, holds, bound in self._bounds)
        inside &= abs(number) < LARGEST or (self.endless and number == math.inf)
        if not inside:
            known = "" if isinstance(value, int | float) else f", {number:.6g} {self.unit}".rstrip()
            known += ", more than any quantity" if LARGEST <= abs(number) < math.inf else ""
            raise InputError(
                f"Read {shown(value)}{known}. Expected {self.range_text()}. "
                f"Write for example `{self.example}`."
            )
        return number

    @property
    def _bounds(self) -> list[tuple[str, str, Callable[[float, float], bool], float]]:
        """Each bound in words and in JSON Schema, what makes a number keep it, and its value."""
        bounds = (
            ("above", "exclusiveMinimum", operator.gt, self.above),
            ("at least", "minimum", operator.ge, self.at_least),
            ("at most", "maximum", operator.le, self.at_most),
            ("below", "exclusiveMaximum", operator.lt, self.below),
        )
        return [(word, key, holds, n) for word, key, holds, n in bounds if n is not None]

    def range_text(self) -> str:
        """What is expected, in words."""
        parts = [f"{word} {bound:.6g}" for word, _, _, bound in self._bounds]
        kind = f"a number in {self.unit}" if self.unit else "a number"
        last = ", or .inf for no limit" if self.endless else ""
        return " ".join([kind, " and ".join(parts) or "that is finite"]) + last

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema: a number within the range, or a text with a unit."""
        number = {"type": "number", **{key: bound for _, key, _, bound in self._bounds}}
        unit = self.unit or "dimensionless"
        text = {"type": "string", "description": f"a number with a unit of the kind {unit}"}
        return {"anyOf": [number, text], "examples": [self.example], "x-unit": unit}
