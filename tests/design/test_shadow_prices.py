"""A shadow price is the speed gained per unit of its limit, as re-solved problems show."""

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import Interval


def slope(problem, name, step):
    speeds = [
        abs(
            maximize_speed(
                replace(
                    problem,
                    limits=replace(
                        problem.limits, **{name: getattr(problem.limits, name) * (1 + sign * step)}
                    ),
                )
            ).best.speed
        )
        for sign in (1, -1)
    ]
    return (speeds[0] - speeds[1]) / (2 * step * getattr(problem.limits, name))


@pytest.mark.parametrize(
    ("name", "limit"),
    [
        ("reference", "rate"),
        ("reference_torque", "torque"),
        ("reference_torque", "rate"),
        ("tight_margin", "singularity"),
    ],
)
def test_price_of_a_limit(name, limit):
    problem = PROBLEMS[name]
    price = maximize_speed(problem).best.prices[limit]
    assert price == pytest.approx(slope(problem, limit, 1e-3), rel=1e-2, abs=1e-6)
    if limit != "singularity":
        assert price > 0


def test_price_of_the_angle():
    problem = PROBLEMS["straight"]
    problem = replace(problem, limits=replace(problem.limits, angle=0.9))
    price = maximize_speed(problem).best.prices["angle"]
    assert price > 0.01
    assert price == pytest.approx(slope(problem, "angle", 1e-3), rel=1e-2)


def test_price_of_a_bound():
    problem = PROBLEMS["straight"]
    gait = replace(problem.gait, period=Interval(0.3, 2.0))
    step = 1e-3
    best = maximize_speed(replace(problem, gait=gait)).best
    speeds = [
        maximize_speed(
            replace(problem, gait=replace(gait, period=Interval(0.3, 2.0 + s)))
        ).best.speed
        for s in (step, -step)
    ]
    found = (speeds[0] - speeds[1]) / (2 * step)
    assert best.bound_prices["period"] == pytest.approx(found, rel=1e-2)
