"""How strong an effect has to be to be seen as well as asked."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from rr_opt.lab.case import Case
from rr_opt.lab.effects import effect_named
from rr_opt.robot.parameters import EffectUse

TRIES = 6
CLOSE = 0.1
"""Relative; a strength is drawn over decades, so nothing is gained by more."""


def scaled_use(use: EffectUse, factor: float) -> EffectUse:
    """The effect `factor` times as strong; its places and directions stay."""
    effect = effect_named(use.name)
    values = {
        name: effect.parameter(name).scaled(value, factor) for name, value in use.values.items()
    }
    return EffectUse(use.name, values)


def scaled_case(case: Case, factor: float) -> Case:
    """All effects of a case `factor` times as strong."""
    return replace(case, effects=tuple(scaled_use(use, factor) for use in case.effects))


def at_visibility(
    case: Case, target: float, visibility: Callable[[Case], float]
) -> tuple[Case, float]:
    """The case with its effects scaled together until visibility(case) is `target`, and what it is.

    visibility  RMS deviation from the nominal, in sigma; it is taken to grow with the strength.
    The secant method on logarithms; where the effects reach what is believable first, or hardly
    change what is seen (a limit that is not met), the nearest that was tried is returned.
    """
    low, high = 1e-4, 1e4
    factor, best = 1.0, None
    power = 1.0
    seen: list[tuple[float, float]] = []
    for _ in range(TRIES):
        trial = scaled_case(case, factor)
        reached = max(visibility(trial), 1e-6)
        if best is None or _miss(reached, target) < _miss(best[1], target):
            best = trial, reached
        if _miss(reached, target) < CLOSE:
            break
        low, high = (factor, high) if reached < target else (low, factor)
        if seen:
            power = _slope(seen[-1], (factor, reached), power)
        seen.append((factor, reached))
        wanted = factor * min(max((target / reached) ** (1 / power), 0.05), 20.0)
        factor = wanted if low < wanted < high else (low * high) ** 0.5
    assert best is not None
    return best


def _miss(reached: float, target: float) -> float:
    return max(reached / target, target / reached) - 1


def _slope(one: tuple[float, float], two: tuple[float, float], before: float) -> float:
    """d log(reached) / d log(factor), kept between 0.3 and 3."""
    run = math.log(two[0] / one[0])
    rise = math.log(two[1] / one[1])
    return min(max(rise / run, 0.3), 3.0) if run else before
