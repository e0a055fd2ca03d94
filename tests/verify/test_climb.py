"""From an optimum a climb by SLSQP gains nothing; from a gait that only looks like one, it does."""

import numpy as np
import pytest

from benchmarks.optimise.problems import PROBLEMS
from benchmarks.turn.problems import PROBLEMS as TURNS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.model.robot import EffectUse, Platform, Robot
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.verify.climb import climb
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


def test_a_climb_does_not_ask_for_more_than_dry_friction_resolves():
    dry = EffectUse("coulomb_friction", {"force1": 0.0002029, "force2": 0.0006748})
    robot = Robot(
        Platform(m=0.5994, I=0.003619, c=0.16255, a=0.01884, b=0.06828, kappa=6.475e-6),
        Platform(m=0.2826, I=0.002386, c=0.09013, a=0.02530, b=0.04725, kappa=7.380e-6),
        h=0.0215,
        physics=(dry,),
    )
    limits = Limits(angle=2.6, rate=3.14159, torque=1.5, singularity=0.02)
    gait = GaitBounds(amplitude=Interval(0.05, 2.6), period=Interval(0.3, 3.0))
    problem = Problem(robot, limits, gait)
    end = climb(problem, np.array([1.46685471, 2.93371189, 0.0, np.nan]))
    assert end.kept
    # One that asks for 1e-10 evaluates more than 5 000 gaits.
    assert end.points < 1000
