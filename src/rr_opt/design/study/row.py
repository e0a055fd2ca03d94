"""The outcome of a study case: one row of its table, plain enough for JSON."""

import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Literal, get_args

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
    values = {
        one.name: tuple(value) if isinstance(value := record[one.name], list) else value
        for one in fields(kind)
    }
    for name, value in values.items():
        for number in value if isinstance(value, tuple) else (value,):
            _check_number(name, number)
    return kind(**values)


def row_record(row: Row) -> dict[str, Any]:
    """A row as plain JSON data."""
    return asdict(row)


def row_from(record: Mapping[str, Any]) -> Row:
    """The row of a record. Raises KeyError, TypeError or ValueError if it is not one."""
    values = dict(record)
    statuses = [status.value for status in Status]
    if values["status"] not in statuses:
        raise ValueError(f"`status` is {_shown(values['status'])}, not one of {statuses}")
    values["status"] = Status(values["status"])
    if values["started"] not in get_args(Started):
        started = _shown(values["started"])
        raise ValueError(f"`started` is {started}, not one of {get_args(Started)}")
    _check_fields(Row, values)
    for name in ("tried", "continued"):
        values[name] = _numbers(name, values[name], whole=True)
    if values["expected"] is not None:
        values["expected"] = _numbers("expected", values["expected"], count=2)
    if (values["optimum"] is None) == (values["status"] is Status.OPTIMAL):
        raise ValueError(f"`status` is {values['status'].value!r}, which does not fit `optimum`")
    if values["optimum"] is not None:
        values["optimum"] = _optimum_from(values["optimum"])
    return Row(**values)


def _optimum_from(record: Mapping[str, Any]) -> CaseOptimum:
    values = dict(record)
    _check_fields(CaseOptimum, values)
    held = values["held"]
    if not isinstance(held, (list, tuple)) or not all(isinstance(name, str) for name in held):
        raise ValueError(f"`held` is {_shown(held)}, not a list of names")
    for name in ("prices", "bound_prices"):
        if not isinstance(values[name], dict):
            raise ValueError(f"`{name}` is {_shown(values[name])}, not an object")
        for key, price in values[name].items():
            _check_number(f"{name}.{key}", price)
    gait_from(values["gait"])
    return CaseOptimum(**{**values, "held": tuple(held)})


_PLAIN: dict[Any, str] = {str: "a text", bool: "true or false"}


def _check_fields(kind: type, values: Mapping[str, Any]) -> None:
    """Raise KeyError for a missing field, ValueError for a wrong number, text or boolean."""
    for one in fields(kind):
        value = values[one.name]
        if one.type in (float, int) or (one.type == float | None and value is not None):
            _check_number(one.name, value, whole=one.type is int)
        elif one.type in (str, bool) and type(value) is not one.type:
            raise ValueError(f"`{one.name}` is {_shown(value)}, not {_PLAIN[one.type]}")


def _numbers(
    name: str, values: Any, *, whole: bool = False, count: int | None = None
) -> tuple[Any, ...]:
    if not isinstance(values, (list, tuple)) or (count is not None and len(values) != count):
        raise ValueError(
            f"`{name}` is {_shown(values)}, not a list of {f'{count} ' if count else ''}numbers"
        )
    for value in values:
        _check_number(name, value, whole=whole)
    return tuple(values)


def _check_number(name: str, value: Any, *, whole: bool = False) -> None:
    number = isinstance(value, (float, int)) and not isinstance(value, bool)
    # An integer may be too large for a float.
    if not number or not abs(value) < LARGEST:
        raise ValueError(f"`{name}` is {_shown(value)}, not a finite number")
    if whole and not isinstance(value, int):
        raise ValueError(f"`{name}` is {_shown(value)}, not a whole number")


def _shown(value: Any) -> str:
    """The value read, truncated if long."""
    text = "a number of very many digits" if _endless(value) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _endless(value: Any) -> bool:
    return isinstance(value, int) and abs(value) > sys.float_info.max
