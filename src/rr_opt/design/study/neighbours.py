"""What neighbours tell of a case: which of their optima to go on from, and what speed to expect."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.design.study.row import Optimum, Row, gait_from
from rr_opt.problem import Interval, Problem
from rr_opt.robot.gait import Gait, SineGait

_FACTOR, _OFFSET = 3.0, 0.3
# Amplitudes and periods of optima of one family differ by less than the factor from one case to
# the next, offsets by less than this, rad.


@dataclass(frozen=True)
class Foothold:
    """Where to go on from: at or between the optima of the neighbours of one family."""

    cases: tuple[int, ...]
    sign: int
    gait: Gait
    share: float


def footholds(donors: Sequence[tuple[int, float]], rows: Mapping[int, Row]) -> list[Foothold]:
    """One foothold for each family of optima among the neighbours, that of the nearest first."""
    families: list[list[tuple[int, float, Optimum]]] = []
    for case, weight in sorted(donors, key=lambda donor: -donor[1]):
        optimum = rows[case].optimum
        if optimum is None:
            continue
        family = next((one for one in families if alike(one[0][2], optimum)), None)
        if family is None:
            families.append([(case, weight, optimum)])
        else:
            family.append((case, weight, optimum))
    return [_between(family) for family in families]


def _between(family: Sequence[tuple[int, float, Optimum]]) -> Foothold:
    """A start between the optima of a family, nearest first, where this case lies between them."""
    cases, given, optima = zip(*family, strict=True)
    nearest = optima[0]
    gait = gait_from(nearest.gait)
    weights = np.array(given) / sum(given)

    def mean(name: str) -> float:
        return float(weights @ [abs(getattr(one, name)) for one in optima])

    def power_mean(name: str) -> float:
        return math.exp(weights @ [math.log(getattr(one, name)) for one in optima])

    if isinstance(gait, SineGait):
        # A gait and its mirror image, phi0 and -phi0, are one.
        offset = math.copysign(mean("offset"), gait.offset)
        gait = SineGait(power_mean("amplitude"), power_mean("period"), offset)
    return Foothold(tuple(cases), nearest.sign, gait, mean("share"))


def alike(one: Optimum, other: Optimum) -> bool:
    """Whether two optima of neighbouring cases look like one family: the same direction, held by
    the same limits and bounds or their gaits near each other."""

    def near(a: float, b: float) -> bool:
        return max(a, b) < _FACTOR * min(a, b)

    return (
        one.sign == other.sign
        and abs(abs(one.offset) - abs(other.offset)) < _OFFSET
        and (
            one.held == other.held
            or (near(one.amplitude, other.amplitude) and near(one.period, other.period))
        )
    )


def expected_speed(
    problem: Problem,
    donors: Sequence[tuple[int, float]],
    rows: Mapping[int, Row],
    problems: Sequence[Problem],
) -> tuple[float, float] | None:
    """The least and the largest |speed|, m/s, that the neighbours let expect; None if one of them
    has no optimum.

    Their speeds can be interpolated, and so can the speeds that each of them foretells by its
    shadow prices. A family whose speed goes with a power of the inputs is met by both; one whose
    speed bends the same way all along lies between that chord and those tangents.
    """
    chord = tangents = 0.0
    for case, weight in donors:
        optimum = rows[case].optimum
        if optimum is None:
            return None
        here = math.log(abs(optimum.speed))
        chord += weight * here
        tangents += weight * (here + _gain(optimum, problems[case], problem))
    if not math.isfinite(tangents):
        return None
    return math.exp(min(chord, tangents)), math.exp(max(chord, tangents))


def _gain(optimum: Optimum, here: Problem, there: Problem) -> float:
    """Gain of log |speed|, to first order, as limits and bounds move from one problem to another.

    First order in the logarithms of limits and bounds where they have one: speeds tend to go with
    their powers.
    """
    moved = [
        (price, getattr(here.limits, name), getattr(there.limits, name))
        for name, price in optimum.prices.items()
        if hasattr(here.limits, name)
    ]
    for name, price in optimum.bound_prices.items():
        side = "low" if f"least {name}" in optimum.held else "high"
        moved.append((price, getattr(_range(here, name), side), getattr(_range(there, name), side)))
    return sum(price * _move(old, new) for price, old, new in moved) / abs(optimum.speed)


def _move(old: float, new: float) -> float:
    if old == new:
        return 0.0
    return old * math.log(new / old) if old > 0 and new > 0 else new - old


def _range(problem: Problem, name: str) -> Interval:
    if name == "inertia_ratio":
        choice = problem.inertia_ratio
        return choice.bounds if choice else Interval(0.0, 0.0)
    return getattr(problem.gait, name)
