"""The outcome of a study case: one row of its table, plain enough for JSON."""

import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, is_dataclass
from types import UnionType
from typing import Any, Literal, get_args, get_origin, get_type_hints

from rr_opt.model.gait import FourierGait, FreeGait, Gait, SineGait
from rr_opt.outcome import Status
from rr_opt.units import LARGEST

Started = Literal["cold", "warm", "warm and cold"]

_GAITS: dict[str, Any] = {one.shape: one for one in (SineGait, FourierGait, FreeGait)}


@dataclass(frozen=True)
class CaseOptimum:
    """The best gait of a case. SI throughout; every number is of the steady cycle.

    gait            its shape and parameters
    share           position of the ballast in its range, 0 to 1
    ratio           J20/J10 in the problem's definition (about P if it has none)
    cycle_length    of the path per period, m; turn: heading gained per period, rad
    radius          of the circle, m; None if the robot goes straight
    peak_*          largest |phi|, |dphi/dt|, |torque|, side force over load; least_s1: smallest S1
    energy          see `study_energy`, J/m and dimensionless
    held            names of the active limits and bounds, such as `rate` or `least period`
    prices          speed gained per unit of an active limit
    bound_prices    the same for active bounds
    sideways        its direction is a matter of definition
    """

    gait: Mapping[str, Any]
    sign: int
    share: float
    speed: float
    amplitude: float
    period: float
    offset: float
    ratio: float
    cycle_length: float
    turn: float
    radius: float | None
    peak_angle: float
    peak_rate: float
    peak_torque: float
    least_s1: float
    peak_grip: float
    energy_per_metre: float
    net_energy_per_metre: float
    cost_of_transport: float
    held: tuple[str, ...]
    prices: Mapping[str, float]
    bound_prices: Mapping[str, float]
    sideways: bool = False


@dataclass(frozen=True)
class Row:
    """How a case ended.

    optimum    None unless status is OPTIMAL
    started    from cold starts, from neighbours' optima (warm), or both
    tried      neighbouring cases whose optima were used as warm starts
    continued  those that led to this optimum
    expected   range of |speed| predicted from the neighbours, m/s
    seconds    CPU time spent on it by its process
    """

    status: Status
    message: str
    optimum: CaseOptimum | None = None
    started: Started = "cold"
    tried: tuple[int, ...] = ()
    continued: tuple[int, ...] = ()
    expected: tuple[float, float] | None = None
    seconds: float = 0.0
    iterations: int = 0


def gait_record(gait: Gait) -> dict[str, Any]:
    """A gait's own parameters by name."""
    return {"shape": gait.shape, **asdict(gait)}  # type: ignore[call-overload]


def gait_from(record: Mapping[str, Any]) -> Gait:
    """The gait of a record. Raises KeyError, TypeError or ValueError if it is not one."""
    kind = _GAITS.get(record["shape"])
    if kind is None:
        shape = _shown(record["shape"])
        raise ValueError(f"its gait has the shape {shape}, not one of {list(_GAITS)}")
    return _read(kind, "gait", {one.name: record[one.name] for one in fields(kind)})


def row_record(row: Row) -> dict[str, Any]:
    """A row as plain JSON data."""
    return asdict(row)


def row_from(record: Mapping[str, Any]) -> Row:
    """The row of a record. Raises KeyError, TypeError or ValueError if it is not one."""
    row: Row = _read(Row, "row", record)
    if (row.optimum is None) == (row.status is Status.OPTIMAL):
        raise ValueError(f"`status` is {row.status.value!r}, which does not fit `optimum`")
    if row.optimum:
        gait_from(row.optimum.gait)
    return row


_PLAIN: dict[Any, str] = {str: "a text", bool: "true or false"}


def _read(kind: Any, name: str, value: Any) -> Any:
    """A value of this type, from what JSON makes of it. Raises KeyError for a missing field of a
    dataclass, TypeError for an unknown one, ValueError for a wrong value."""
    origin, args = get_origin(kind), get_args(kind)
    if origin is UnionType:
        return None if value is None else _read(args[0], name, value)
    if isinstance(kind, type) and is_dataclass(kind):
        values, kinds = dict(value), get_type_hints(kind)
        for one in fields(kind):
            values[one.name] = _read(kinds[one.name], one.name, values[one.name])
        return kind(**values)
    if origin is tuple:
        count = None if args[-1] is ... else len(args)
        listed = isinstance(value, (list, tuple)) and len(value) == (count or len(value))
        if args[0] is str:
            _expect(
                listed and all(isinstance(one, str) for one in value),
                name,
                value,
                "a list of names",
            )
        _expect(listed, name, value, f"a list of {f'{count} ' if count else ''}numbers")
        return tuple(_read(args[0], name, one) for one in value)
    if origin is Mapping:
        _expect(isinstance(value, dict), name, value, "an object")
        return {key: _read(args[1], f"{name}.{key}", one) for key, one in value.items()}
    if kind is Status or origin is Literal:
        choices = [status.value for status in Status] if kind is Status else args
        _expect(value in choices, name, value, f"one of {choices}")
        return Status(value) if kind is Status else value
    if kind in _PLAIN:
        _expect(type(value) is kind, name, value, _PLAIN[kind])
    elif kind is not Any:
        number = isinstance(value, (float, int)) and not isinstance(value, bool)
        # An integer may be too large for a float.
        _expect(number and abs(value) < LARGEST, name, value, "a finite number")
        _expect(kind is float or isinstance(value, int), name, value, "a whole number")
    return value


def _expect(good: bool, name: str, value: Any, what: str) -> None:
    if not good:
        raise ValueError(f"`{name}` is {_shown(value)}, not {what}")


def _shown(value: Any) -> str:
    """The value read, truncated if long."""
    text = "a number of very many digits" if _endless(value) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _endless(value: Any) -> bool:
    return isinstance(value, int) and abs(value) > sys.float_info.max
