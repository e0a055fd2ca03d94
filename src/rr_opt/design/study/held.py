"""Which limits and bounds an optimum stands on, and what each of them costs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from rr_opt.design.decisions import ballast_interval
from rr_opt.design.solve import Candidate
from rr_opt.problem import Interval, Problem, RatioChoice

_ON = 1e-4
"""A limit holds a gait that comes this near to it, relative to the limit."""


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
        if _on_limit(name, value, getattr(problem.limits, name))
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


def _on_limit(name: str, value: float, limit: float) -> bool:
    slack = value - limit if name == "singularity" else limit - value
    return math.isfinite(limit) and slack <= _ON * abs(limit)


def _bounds(
    problem: Problem, best: Candidate, ratio: float
) -> Iterator[tuple[str, str, float | None]]:
    gait = problem.gait
    for name, box in (("amplitude", gait.amplitude), ("period", gait.period),
                      ("offset", gait.offset)):  # fmt: skip
        side = _side(getattr(best.gait, name), box)
        if side:
            yield name, side, best.bound_prices.get(name)
    choice = problem.inertia_ratio
    side = _side(ratio, choice.bounds) if choice else None
    if choice and side:
        whole = choice.by == "loads" and choice.loads.whole
        price = None if whole else best.bound_prices["ballast"] * _share_per_ratio(problem, choice)
        yield "inertia_ratio", side, price


def _side(value: float, box: Interval) -> str | None:
    """`least` or `largest` if the value is at that end of a range that leaves a choice."""
    near = _ON * min(box.high - box.low, max(abs(box.low), abs(box.high)))
    if box.fixed:
        return None
    return "least" if value - box.low <= near else "largest" if box.high - value <= near else None


def _share_per_ratio(problem: Problem, choice: RatioChoice) -> float:
    """How far the ballast's share of its range moves per unit of J20/J10, at the upper bound."""

    def amount(ratio: float) -> float:
        fixed = replace(choice, bounds=Interval(ratio, ratio))
        return ballast_interval(problem.robot, fixed).high

    span, high = ballast_interval(problem.robot, choice), choice.bounds.high
    step = 1e-6 * high
    return (amount(high) - amount(high - step)) / step / (span.high - span.low)
