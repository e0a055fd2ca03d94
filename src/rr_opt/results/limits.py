"""How close an optimum is to each limit and bound, and the gain from relaxing it."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal

from rr_opt.design.decisions import share_per_ratio
from rr_opt.design.maximize_speed import Optimum
from rr_opt.documents import document as doc
from rr_opt.formatting import QUANTITIES, number, price_text, with_unit
from rr_opt.messages import listed
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LEAST, NEEDS_GRIP, Interval

ACTIVE = 1e-4
"""A limit is active when the gait is within this distance of it, relative to the limit."""

LIMIT_NAMES = ("angle", "rate", "torque", "singularity", "grip")
"""Limits of every problem."""
TOTAL_NAMES = ("power", "cost_of_transport", "speed")
"""Limits on totals over a period, shown if set."""
BOUND_NAMES = ("amplitude", "period", "offset", "inertia_ratio")

_WORDS = {
    "angle": "the joint angle",
    "rate": "the joint rate",
    "torque": "the servo torque",
    "singularity": "the singularity margin",
    "grip": "the grip of the wheels",
    "power": "the power of the servo",
    "cost_of_transport": "the cost of transport",
    "speed": "the least speed",
}


@dataclass(frozen=True)
class LimitRow:
    """A limit, and how close the gait comes to it.

    limit         SI; inf if there is none
    value         the extreme over the replayed cycle, SI; NaN if there is no gait
    active        whether the limit constrains the optimum
    shadow_price  m/s of |speed| gained per SI unit by which the limit is raised, or the decrease of
                  the cost of transport; 0 if inactive, NaN if there is no gait
    """

    name: str
    limit: float
    value: float = math.nan
    active: bool = False
    shadow_price: float = math.nan


@dataclass(frozen=True)
class BoundRow:
    """A decision of the problem within its bounds.

    active        the active bound, if any
    shadow_price  m/s of |speed| per unit by which that bound moves up, 0 if neither is active;
                  None where no price exists: a fixed decision, or a whole number of loads
    """

    name: str
    value: float
    low: float
    high: float
    active: Literal["low", "high", "fixed"] | None
    shadow_price: float | None


def limit_row(name: str, optimum: Optimum, reached: Mapping[str, float]) -> LimitRow:
    """A limit by name; reached: the extremes over the cycle by limit, empty without a gait."""
    best, limit = optimum.best, getattr(optimum.problem.limits, name)
    if not reached or best is None:
        return LimitRow(name, limit)
    value, price = reached[name], best.prices[name]
    slack = value - limit if name in LEAST else limit - value
    active = bool(math.isfinite(limit) and slack <= ACTIVE * abs(limit))
    if optimum.problem.gait.shape != "sine":
        # Its peaks may stay short of the limit, which the optimiser tightens slightly.
        active |= _matters(price, limit, best.speed)
    return LimitRow(name, limit, value, active, price if active else 0.0)


def bound_rows(optimum: Optimum, commanded: Gait, ratio: float) -> dict[str, BoundRow]:
    """Amplitude, period, offset, the inertia ratio if it is a decision; empty without a gait."""
    best, gait, choice = optimum.best, optimum.problem.gait, optimum.problem.inertia_ratio
    if best is None:
        return {}
    boxes = {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset}
    if command := optimum.problem.command:
        shift = command.servo.shift
        offset = Interval(gait.offset.low - shift, gait.offset.high - shift)
        boxes |= {"amplitude": command.amplitude, "offset": offset}
    prices = best.bound_prices
    rows = {
        name: _bound(name, getattr(commanded, name), box, prices[name])
        for name, box in boxes.items()
    }
    if gait.shape != "sine":
        rows["amplitude"] = _swing(rows["amplitude"], prices["amplitude"], best.speed)
    if choice:
        whole = choice.by == "loads" and choice.loads.whole
        per_ratio = share_per_ratio(optimum.problem.robot, choice)
        price = None if whole else prices["ballast"] * per_ratio
        rows["inertia_ratio"] = _bound("inertia_ratio", ratio, choice.bounds, price)
    return rows


def slippery(grip: float) -> tuple[str, ...]:
    """A warning of side forces, relative to loads, that wheels rarely sustain."""
    if not grip > NEEDS_GRIP:
        return ()
    return (
        f"The wheels need a coefficient of friction of {grip:.2g} not to slip sideways, which "
        f"few floors have (above {NEEDS_GRIP:g}). `limits.grip` limits it.",
    )


def worst_slack(optimum: Optimum, command: Gait, reached: Mapping[str, float]) -> tuple[str, float]:
    """Complementary slackness: at an optimum a limit with a nonzero price is active, and no price
    has the wrong sign. The worst violation: its limit or bound, and price times slack, or times the
    limit if the sign is wrong, relative to the speed or the cost of transport.
    """
    best, problem = optimum.best, optimum.problem
    if best is None:
        return "", 0.0
    worth: dict[str, float] = {}
    for name, value in reached.items():
        limit, price = getattr(problem.limits, name), best.prices[name]
        if math.isfinite(limit):
            slack, price = (value - limit, -price) if name in LEAST else (limit - value, price)
            called = f"limit on {_WORDS[name]}"
            worth[called] = max(price * max(slack, 0.0), -price * abs(limit))
    gait, prices = problem.gait, best.bound_prices
    boxes = {"period": gait.period, "offset": gait.offset}
    if problem.gait.shape == "sine" and not problem.command:
        boxes["amplitude"] = gait.amplitude
    places = [(name, getattr(command, name), box) for name, box in boxes.items()]
    for name, value, box in (*places, ("ballast", best.share, Interval(0.0, 1.0))):
        away = max(box.high - value if prices[name] > 0 else value - box.low, 0.0)
        called = "J20/J10" if name == "ballast" else name
        worth[f"bound on {called}"] = 0.0 if box.fixed else abs(prices[name]) * away
    name = max(worth, key=lambda one: worth[one])
    return name, worth[name] / best.value


def _bound(name: str, value: float, box: Interval, price: float | None) -> BoundRow:
    if box.fixed:
        return BoundRow(name, value, box.low, box.high, "fixed", None)
    near = ACTIVE * min(box.high - box.low, max(abs(box.low), abs(box.high)))
    side: Literal["low", "high"] | None = None
    if value - box.low <= near:
        side = "low"
    elif box.high - value <= near:
        side = "high"
    return BoundRow(name, value, box.low, box.high, side, price if side else 0.0)


def _matters(price: float, limit: float, speed: float) -> bool:
    """Whether dropping the limit would change the speed by more than the solver's residual."""
    return math.isfinite(limit) and abs(price * limit) > ACTIVE * abs(speed)


def _swing(row: BoundRow, price: float, speed: float) -> BoundRow:
    """The row of the amplitude of a gait that is no sine: the lower bound is on its first
    harmonic and the upper one on its swing, so the price shows which is active."""
    if row.active == "fixed":
        return row
    side: Literal["low", "high"] = "high" if price > 0 else "low"
    edge = row.high if price > 0 else row.low
    active = side if _matters(price, edge, speed) else None
    return replace(row, active=active, shadow_price=price)


def limited_by(limits: Iterable[LimitRow], bounds: Iterable[BoundRow]) -> str:
    """`It is limited by the joint rate and the lower bound on the period.`"""
    active = [_WORDS[row.name] for row in limits if row.active]
    active += [
        f"the {'lower' if row.active == 'low' else 'upper'} bound on the "
        f"{QUANTITIES[row.name].words}"
        for row in bounds
        if row.active in ("low", "high")
    ]
    if not active:
        return "No limit or bound is active: it is an interior optimum."
    return f"It is limited by {listed(active)}."


def limits_table(
    rows: Iterable[LimitRow],
    reached: bool,
    objective: str = "speed",
    where: Mapping[str, str] | None = None,
) -> doc.Table:
    """Each limit: the value reached, where (if known), the allowed value, and its shadow price."""
    kinds = [(QUANTITIES[row.name], row) for row in rows]
    if not reached:
        return doc.table(["Limit", "Allowed"], [[k.words, k.both(row.limit)] for k, row in kinds])
    return doc.table(
        ["Limit", "Reached", *(["Where"] if where else []), "Allowed", "State", "Shadow price"],
        [
            [
                kind.words,
                kind.both(row.value),
                *([where[row.name]] if where else []),
                kind.both(row.limit),
                doc.Badge("active", "good") if row.active else doc.Badge("not active"),
                price_text(row.name, row.shadow_price, objective) if row.active else None,
            ]
            for kind, row in kinds
        ],
    )


def bounds_table(bounds: Iterable[BoundRow], objective: str = "speed") -> doc.Table:
    """Each decision, its range, and the shadow price of its active bound."""
    states = {
        "low": doc.Badge("at lower bound", "good"),
        "high": doc.Badge("at upper bound", "good"),
        "fixed": doc.Badge("fixed"),
        None: doc.Badge("inside"),
    }
    rows = []
    for row in bounds:
        kind, fixed = QUANTITIES[row.name], row.active == "fixed"
        span = "fixed" if fixed else f"{number(row.low)} to {with_unit(row.high, kind.unit)}"
        price = None
        if row.active in ("low", "high") and row.shadow_price is not None:
            price = price_text(row.name, row.shadow_price, objective)
        rows.append([kind.words, kind.both(row.value), span, states[row.active], price])
    return doc.table(["Decision", "Value", "Range", "State", "Shadow price"], rows)
