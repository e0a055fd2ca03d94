"""A reported price is the speed gained per unit: solving again with a moved limit shows it."""

from dataclasses import replace

import pytest

from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import Interval, RatioChoice
from rr_opt.results.fastest import FastestGait


def speed(problem):
    best = maximize_speed(problem).best
    assert best is not None
    return abs(best.speed)


def test_price_of_the_rate_limit(answer):
    problem = answer.optimum.problem
    price = answer.limits["rate"].shadow_price
    step = 1e-3 * problem.limits.rate
    more = replace(problem, limits=replace(problem.limits, rate=problem.limits.rate + step))
    less = replace(problem, limits=replace(problem.limits, rate=problem.limits.rate - step))
    assert price == pytest.approx((speed(more) - speed(less)) / (2 * step), rel=1e-3)


@pytest.mark.parametrize("by", ["inertia", "loads"])
def test_price_of_the_inertia_ratio_is_per_unit_of_the_ratio(answer, by):
    problem = answer.optimum.problem

    def with_most(high):
        return replace(problem, inertia_ratio=RatioChoice(Interval(0.13, high), by=by))

    row = FastestGait("", "", maximize_speed(with_most(0.2))).bounds["inertia_ratio"]
    assert row.active == "high"
    step = 2e-4
    slope = (speed(with_most(0.2 + step)) - speed(with_most(0.2 - step))) / (2 * step)
    assert row.shadow_price == pytest.approx(slope, rel=1e-2)
