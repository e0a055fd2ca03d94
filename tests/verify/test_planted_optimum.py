"""A planted wrong optimum is caught by the sweep, and a true one is not."""

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.verify.sweep import check_optimum

NAMES = ["reference", "straight_torque", "paper", "turn_away"]


@pytest.fixture(scope="module", params=NAMES)
def case(request):
    problem = PROBLEMS[request.param]
    return problem, maximize_speed(problem)


def test_true_optimum_passes(case):
    problem, optimum = case
    best = optimum.best
    check = check_optimum(problem, best.gait, optimum.ratio, best.speed)
    assert check.points > 1000
    assert -1e-4 <= check.gap < 1e-4


def test_a_slightly_slower_gait_is_caught(case):
    problem, optimum = case
    gait = replace(optimum.best.gait, amplitude=0.99 * optimum.best.gait.amplitude)
    speed = steady_cycle(optimum.robot, gait).speed
    assert abs(speed) < abs(optimum.best.speed) * (1 - 5e-4)
    assert check_optimum(problem, gait, optimum.ratio, speed).gap < -1e-4


def test_a_speed_the_gait_does_not_have_is_caught():
    problem = PROBLEMS["paper"]
    optimum = maximize_speed(problem)
    check = check_optimum(problem, optimum.best.gait, optimum.ratio, 1.05 * optimum.best.speed)
    assert not check.passed
