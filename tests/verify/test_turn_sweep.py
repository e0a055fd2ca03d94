"""The sweep of a turn finds what the optimiser found, and refutes a slower gait."""

import pytest

from benchmarks.turn.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.verify.sweep import check_optimum


@pytest.mark.parametrize("name", ["short_2m", "reference_whole_torque"])
def test_the_optimum_stands(name):
    problem = PROBLEMS[name]
    optimum = maximize_speed(problem)
    check = check_optimum(problem, optimum.best.gait, optimum.ratio, optimum.best.speed)
    assert check.passed
    assert abs(check.gap) < 1e-4
    made = steady_cycle(problem.robot, check.best.gait).cycle
    if problem.inertia_ratio is None:
        assert made.dpsi / made.period / abs(made.speed) == pytest.approx(0.5, rel=1e-5)


def test_a_slower_gait_does_not():
    problem = PROBLEMS["short_2m"]
    gait = SineGait(1.0, 2.2, -0.15)
    speed = steady_cycle(problem.robot, gait).speed
    check = check_optimum(problem, gait, None, speed)
    assert not check.passed
    assert check.gap < -0.01
