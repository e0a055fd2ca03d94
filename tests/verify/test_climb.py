"""From an optimum a climb by SLSQP gains nothing; from a gait that only looks like one, it does."""

import pytest

from benchmarks.optimise.problems import PROBLEMS
from benchmarks.turn.problems import PROBLEMS as TURNS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.verify.sweep import check_optimum, sweep

NAMES = ["straight_torque", "paper_torque", "low_friction_torque", "short_2m", "short_30cm"]


@pytest.fixture(scope="module", params=NAMES)
def case(request):
    problem = {**PROBLEMS, **TURNS}[request.param]
    return problem, maximize_speed(problem), sweep(problem)


def test_nothing_is_gained_from_an_optimum(case):
    problem, optimum, swept = case
    best = optimum.best
    check = check_optimum(problem, best.gait, optimum.ratio, best.speed, everywhere=swept)
    assert check.passed
    assert abs(check.gained) < 1e-6
    assert abs(check.gap) < 1e-6


def test_a_thousandth_below_is_refuted(case):
    problem, optimum, swept = case
    gait = optimum.best.gait
    gait = SineGait(gait.amplitude * (1 - 1e-3), gait.period * (1 + 1e-4), gait.offset)
    speed = steady_cycle(optimum.robot, gait).speed
    check = check_optimum(problem, gait, optimum.ratio, speed, everywhere=swept)
    assert check.better is not None
