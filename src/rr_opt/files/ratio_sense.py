"""Whether the robot can be given the inertia ratios that a problem asks for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rr_opt.files.issue import Level
from rr_opt.outcome import InputError
from rr_opt.problem import Interval, RatioChoice
from rr_opt.robot.ballast import inertia_ratio, with_inertia_ratio
from rr_opt.robot.parameters import Robot

Finding = tuple[Level, str, str]
"""Level, key under `inertia_ratio`, message."""

_ROUNDING = 1e-9


def reachable(choice: RatioChoice, robot: Robot) -> RatioChoice:
    """The choice without the ratios below the robot's own, if loads realise it: they only add."""
    own = inertia_ratio(robot, choice.about)
    low, high = choice.bounds.low, choice.bounds.high
    if choice.by == "inertia" or low >= own or high < own * (1 - _ROUNDING):
        return choice
    return replace(choice, bounds=Interval(own, max(own, high)))


def ratio_findings(choice: RatioChoice, robot: Robot) -> Iterator[Finding]:
    """What is wrong with a choice of ratios for this robot; the messages name a remedy."""
    loads = choice.loads
    if choice.by == "loads" and loads.distance == loads.spread == 0:
        yield (
            "error",
            "loads",
            "Read loads at the joint itself, which do not change the inertia about it. "
            "Give `distance` or `spread` a value above 0.",
        )
        return
    bounds = reachable(choice, robot).bounds
    for ratio in sorted({bounds.low, bounds.high}):
        try:
            with_inertia_ratio(robot, ratio, choice.about, choice.by, loads)
        except InputError as error:
            yield "error", "bounds", str(error)
            return
    if bounds.low > choice.bounds.low * (1 + _ROUNDING):
        yield (
            "warning",
            "bounds",
            f"The robot without loads has {bounds.low:.4g} already, and loads only add to it. "
            f"The ratios from {choice.bounds.low:.4g} up to there are left out.",
        )
