"""What the optimum lies against: each limit and each bound, its value and its shadow price."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

from rr_opt.design.decisions import ballast_interval
from rr_opt.design.maximize_speed import Optimum
from rr_opt.problem import Interval, Problem, RatioChoice
from rr_opt.verify.replay import Replay

ACTIVE = 1e-4
"""A limit is active when the gait comes this near to it, relative to the limit."""

LIMIT_NAMES = ("angle", "rate", "torque", "singularity")


@dataclass(frozen=True)
class LimitRow:
    """A limit: what the gait reaches, SI (seen in the replay), and the speed gained per unit.

    limit   inf if there is none
    price   m/s of |speed| per SI unit by which the limit is raised; 0 if it is not active
    """

    name: str
    value: float
    limit: float
    active: bool
    price: float


@dataclass(frozen=True)
class BoundRow:
    """A decision of the problem within its bounds.

    side   which bound holds it, if one does
    price  m/s of |speed| per unit by which that bound moves up; None where no price exists: a
           decision that is fixed, or a whole number of loads
    """

    name: str
    value: float
    low: float
    high: float
    side: Literal["low", "high", "fixed"] | None
    price: float | None


def limit_rows(optimum: Optimum, replay: Replay) -> list[LimitRow]:
    """A row for each limit, in the order of the problem file."""
    rows = []
    for name in LIMIT_NAMES:
        limit, value = getattr(optimum.problem.limits, name), replay.reached[name]
        slack = value - limit if name == "singularity" else limit - value
        price = optimum.best.prices[name] if optimum.best else 0.0
        active = bool(math.isfinite(limit) and slack <= ACTIVE * abs(limit))
        if optimum.problem.gait.shape != "sine" and optimum.best:
            # Its peaks may stay short of a limit that the program holds somewhat tighter.
            active |= _matters(price, limit, optimum.best.speed)
        price = price if active else 0.0
        rows.append(LimitRow(name, value, limit, active, price))
    return rows


def bound_rows(optimum: Optimum) -> list[BoundRow]:
    """A row for each decision: amplitude, period, offset, and the inertia ratio if it is one."""
    best, problem = optimum.best, optimum.problem
    if best is None or optimum.ratio is None:
        return []
    gait = problem.gait
    rows = [
        _bound(name, getattr(best.gait, name), getattr(gait, name), best.bound_prices[name])
        for name in ("amplitude", "period", "offset")
    ]
    if gait.shape != "sine":
        rows[0] = _swing(rows[0], best.bound_prices["amplitude"], best.speed)
    choice = problem.inertia_ratio
    if choice:
        whole = choice.by == "loads" and choice.loads.whole
        price = None if whole else best.bound_prices["ballast"] * _share_per_ratio(problem, choice)
        rows.append(_bound("inertia_ratio", optimum.ratio, choice.bounds, price))
    return rows


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
    """Whether giving way in full would change the speed by more than solvers leave behind."""
    return math.isfinite(limit) and abs(price * limit) > ACTIVE * abs(speed)


def _swing(row: BoundRow, price: float, speed: float) -> BoundRow:
    """The row of the amplitude where the least one bounds the first harmonic and the largest one
    the swing: the price tells which of them holds."""
    if row.side == "fixed":
        return row
    side: Literal["low", "high"] = "high" if price > 0 else "low"
    edge = row.high if price > 0 else row.low
    return replace(row, side=side if _matters(price, edge, speed) else None, price=price)


def _share_per_ratio(problem: Problem, choice: RatioChoice) -> float:
    """How far the ballast's share of its range moves per unit of J20/J10, at the upper bound."""
    robot, high = problem.robot, choice.bounds.high

    def amount(ratio: float) -> float:
        fixed = RatioChoice(Interval(ratio, ratio), choice.about, choice.by, choice.loads)
        return ballast_interval(robot, fixed).high

    span = ballast_interval(robot, choice)
    if span.fixed:
        return 0.0
    return (amount(high) - amount(high * (1 - 1e-6))) / (high * 1e-6) / (span.high - span.low)
