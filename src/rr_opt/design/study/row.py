"""What a case of a study came to: one row of its table, plain enough to be kept as JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Literal

from rr_opt.model.gait import FourierGait, FreeGait, Gait, SineGait
from rr_opt.outcome import Status

Started = Literal["cold", "warm", "warm and cold"]

_GAITS: dict[str, Any] = {one.shape: one for one in (SineGait, FourierGait, FreeGait)}


@dataclass(frozen=True)
class Optimum:
    """The best gait of a case. SI throughout; every number is of the steady cycle.

    gait            its shape and parameters
    share           where in its range the ballast is, 0 to 1
    ratio           J20/J10 in the problem's definition (about P if it has none)
    cycle_length    of the path per period, m; turn: heading gained per period, rad
    radius          of the circle, m; None if the robot goes straight
    peak_*          largest |phi|, |dphi/dt|, |torque|; least_s1: smallest S1
    energy          see `study_energy`, J/m and dimensionless
    held            names of the limits and bounds it stands on, `rate` or `least period`
    prices          speed gained per unit by which a limit that holds it is raised
    bound_prices    the same for bounds
    sideways        which way it goes is a matter of definition
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
    tried      neighbouring cases whose optima were continued into this case
    continued  those of them from which this optimum was reached
    expected   least and largest |speed| that the neighbours let expect, m/s
    seconds    of CPU spent on it by its process
    """

    status: Status
    message: str
    optimum: Optimum | None = None
    started: Started = "cold"
    tried: tuple[int, ...] = ()
    continued: tuple[int, ...] = ()
    expected: tuple[float, float] | None = None
    seconds: float = 0.0
    iterations: int = 0


def gait_record(gait: Gait) -> dict[str, Any]:
    """A gait under the names of its own parameters."""
    return {"shape": gait.shape, **asdict(gait)}  # type: ignore[call-overload]


def gait_from(record: Mapping[str, Any]) -> Gait:
    """The gait of a record."""
    values = {
        name: tuple(value) if isinstance(value, list) else value
        for name, value in record.items()
        if name != "shape"
    }
    return _GAITS[record["shape"]](**values)


def row_record(row: Row) -> dict[str, Any]:
    """A row as JSON can hold it."""
    return asdict(row)


def row_from(record: Mapping[str, Any]) -> Row:
    """The row of a record."""
    values = {one.name: record[one.name] for one in fields(Row)}
    values["status"] = Status(values["status"])
    if values["expected"] is not None:
        values["expected"] = tuple(values["expected"])
    values["tried"], values["continued"] = tuple(values["tried"]), tuple(values["continued"])
    if values["optimum"] is not None:
        held = tuple(values["optimum"]["held"])
        values["optimum"] = Optimum(**{**values["optimum"], "held": held})
    return Row(**values)
