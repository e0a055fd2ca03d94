"""Prices of the limits of other shapes than the sine are what a re-solved problem gains."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.decisions import decisions, settings_of
from rr_opt.design.families import refine, solve_from
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import GaitBounds, Problem


def climbed(problem: Problem, sign: int, gait: Gait):
    setting = settings_of(problem, decisions(problem))[0]
    return refine(setting, solve_from(setting, sign, gait, 1.0))


@pytest.mark.parametrize(
    ("name", "shape", "limit"),
    [("paper_forward", "fourier", "rate"), ("paper_torque", "free", "torque")],
)
def test_price(name: str, shape: str, limit: str) -> None:
    problem = PROBLEMS[name]
    sign = 1 if name == "paper_forward" else -1
    gait: GaitBounds = replace(problem.gait, shape=shape, intervals=48)  # type: ignore[arg-type]
    value = getattr(problem.limits, limit)

    def asked(factor: float) -> Problem:
        limits = replace(problem.limits, **{limit: value * factor})
        return replace(problem, gait=gait, limits=limits)

    middle = climbed(asked(1.0), sign, SineGait(0.7, 1.5))
    low, high = (climbed(asked(factor), sign, middle.gait) for factor in (0.99, 1.01))
    assert all(one.success for one in (low, middle, high))
    gained = (abs(high.speed) - abs(low.speed)) / (0.02 * value)
    assert middle.prices[limit] == pytest.approx(gained, rel=0.01)
