"""What the tests of reports share: a small problem, solved once, with its evidence."""

import pytest

from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.files.problem_file import read_problem
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.results.fastest import FastestGait
from rr_opt.verify.evaluate import Found
from rr_opt.verify.replay import replay
from rr_opt.verify.sweep import SweepCheck


@pytest.fixture(scope="session")
def answer() -> FastestGait:
    shipped = read_problem(None)
    gait = GaitBounds(Interval(0.1, 1.2), Interval(0.8, 1.6), Interval(0.0, 0.0))
    problem = Problem(shipped.robot, shipped.limits, gait)
    optimum = maximize_speed(problem)
    assert optimum.best is not None
    assert optimum.robot is not None
    best = optimum.best
    seen = replay(optimum.robot, best.gait, problem.limits, best.speed)
    slower = Found(best.gait, None, 0.99 * best.speed, 0.0, 0.0, 0.99 * abs(best.speed))
    sweep = SweepCheck(100, slower, 0.01, 0.0, 1e-6, best.speed, 0.0)
    return FastestGait("small", "0" * 64, optimum, seen, sweep)
