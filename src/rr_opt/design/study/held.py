"""Which limits and bounds an optimum stands on, and what each of them costs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from rr_opt.design.decisions import ballast_interval
from rr_opt.design.solve import Candidate
from rr_opt.problem import Interval, Problem, RatioChoice

_ON = 1e-4
"""A limit holds a sine that comes this near to it, relative to the limit."""
_PRICED = 1e-4
"""A limit holds a gait of another shape if raising it by all of itself would, at its price, gain
more than this, relative to the speed."""


@dataclass(frozen=True)
class Held:
    """Names of what holds an optimum, and |speed| gained per unit by which each is raised."""

    names: tuple[str, ...]
    prices: Mapping[str, float]
    bound_prices: Mapping[str, float]


def held(problem: Problem, best: Candidate, reached: Mapping[str, float], ratio: float) -> Held:
    """What holds a candidate; reached: the extremes of angle, rate, torque, singularity."""
    prices = {
        name: best.prices[name]
        for name, value in reached.items()
        if _on_limit(problem, best, name, value)
    }
    prices |= {
        name: price
        for name, price in best.prices.items()
        if name in ("curvature", "yaw_rate", "heading") and abs(price) > 1e-9
    }
    names, bound_prices = list(prices), {}
    for name, side, price in _bounds(problem, best, ratio):
        names.append(f"{side} {name}")
        if price is not None:
            bound_prices[name] = price
    return Held(tuple(names), prices, bound_prices)


def _on_limit(problem: Problem, best: Candidate, name: str, value: float) -> bool:
    """A sine that is held by a limit comes to it. Of another shape the angle stays a little short
    of its limit, and so may the torque: there the price says it."""
    limit = getattr(problem.limits, name)
    if not math.isfinite(limit):
        return False
    if problem.gait.shape != "sine":
        return _matters(best, best.prices[name], limit)
    slack = value - limit if name == "singularity" else limit - value
    return slack <= _ON * abs(limit)


def _matters(best: Candidate, price: float, size: float) -> bool:
    """Whether a limit or bound of this size has a price that is no zero left by the solver."""
    return abs(price) * abs(size) > _PRICED * abs(best.speed)


def _bounds(
    problem: Problem, best: Candidate, ratio: float
) -> Iterator[tuple[str, str, float | None]]:
    gait = problem.gait
    ranges = {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset}
    for name, box in ranges.items():
        price = best.bound_prices.get(name)
        side = _side(problem, best, getattr(best.gait, name), box, price)
        if side:
            yield name, side, price
    choice = problem.inertia_ratio
    if choice is None or choice.bounds.fixed:
        return
    whole = choice.by == "loads" and choice.loads.whole
    price = None if whole else best.bound_prices["ballast"] * _share_per_ratio(problem, choice)
    side = _side(problem, best, ratio, choice.bounds, price)
    if side:
        yield "inertia_ratio", side, price


def _side(
    problem: Problem, best: Candidate, value: float, box: Interval, price: float | None
) -> str | None:
    """`least` or `largest` if a range that leaves a choice holds the value at that end."""
    size = max(abs(box.low), abs(box.high))
    if box.fixed:
        return None
    if problem.gait.shape != "sine" and price is not None:
        at_end = "largest" if price > 0 else "least"
        return at_end if _matters(best, price, size) else None
    near = _ON * min(box.high - box.low, size)
    return "least" if value - box.low <= near else "largest" if box.high - value <= near else None


def _share_per_ratio(problem: Problem, choice: RatioChoice) -> float:
    """How far the ballast's share of its range moves per unit of J20/J10, at the upper bound."""

    def amount(ratio: float) -> float:
        fixed = replace(choice, bounds=Interval(ratio, ratio))
        return ballast_interval(problem.robot, fixed).high

    span, high = ballast_interval(problem.robot, choice), choice.bounds.high
    step = 1e-6 * high
    return (amount(high) - amount(high - step)) / step / (span.high - span.low)
