"""A free gait is held by the limits whose raising makes it faster, at the prices told."""

from dataclasses import replace

import pytest

from rr_opt.design.decisions import decisions, robot_of, settings_of
from rr_opt.design.families import refine, solve_from
from rr_opt.design.study.case import held, reached
from rr_opt.files.problem_file import read_problem
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem, RatioChoice
from rr_opt.motion.steady_cycle import steady_cycle

STEP = 1e-3
ANGLE, RATE, TORQUE = 0.9, 6.28, 1.37


@pytest.fixture(scope="module")
def solve():
    robot = read_problem(None).robot
    bounds = GaitBounds(Interval(0.2, 2.6), Interval(1.2, 1.5), shape="free", intervals=48)
    choice = RatioChoice(Interval(0.04, 0.04))

    def one(limits: Limits, start):
        problem = Problem(robot, limits, bounds, choice)
        (setting,) = settings_of(problem, decisions(problem))
        found = refine(setting, solve_from(setting, 1, start, 0.0))
        assert found.success
        return setting, found

    return one


def test_limits_and_bounds_hold_where_their_price_says_so(solve):
    limits = Limits(ANGLE, RATE, TORQUE)
    setting, here = solve(limits, SineGait(0.8, 1.2))
    robot = robot_of(setting, here.share)
    extremes = reached(robot, steady_cycle(robot, here.gait))
    on = held(setting.problem, here, extremes, 0.04)
    assert extremes["angle"] == pytest.approx(ANGLE, rel=1e-3)
    prices = {}
    for name in ("angle", "rate", "torque"):
        limit = getattr(limits, name)
        low, high = (
            solve(replace(limits, **{name: limit * (1 + side * STEP)}), here.gait)[1].speed
            for side in (-1, 1)
        )
        slope = (high - low) / (2 * STEP * limit)
        if slope * limit > 1e-3 * here.speed:
            prices[name] = slope
    assert "angle" in prices
    assert on.prices == pytest.approx(prices, rel=0.03)
    assert "least period" in on.names
    assert not any("offset" in name or "amplitude" in name for name in on.names)
