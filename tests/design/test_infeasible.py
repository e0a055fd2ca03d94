"""A problem without a feasible gait names the limits that clash and how far each must give."""

import math
from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.outcome import Status
from rr_opt.problem import Interval

STRAIGHT = PROBLEMS["straight"]


def refused(problem):
    optimum = maximize_speed(problem)
    assert optimum.status is Status.INFEASIBLE
    assert optimum.best is None
    return optimum.message


def test_rate():
    gait = replace(STRAIGHT.gait, amplitude=Interval(1.2, 1.2), period=Interval(0.5, 1.0))
    message = refused(replace(STRAIGHT, gait=gait))
    assert "`rate`" in message
    assert f"{2.4 * math.pi:.4g} rad/s" in message
    opened = replace(STRAIGHT.limits, rate=2.4 * math.pi * 1.001)
    fine = maximize_speed(replace(STRAIGHT, gait=gait, limits=opened))
    assert fine.status is Status.OPTIMAL


def test_angle_and_singularity_at_once():
    gait = replace(STRAIGHT.gait, amplitude=Interval(2.0, 2.6), offset=Interval(0.7, 0.8))
    message = refused(replace(STRAIGHT, gait=gait))
    assert "`angle`" in message
    assert "2.7 rad" in message
    assert "`singularity`" in message
    assert "past the singular posture" in message


def test_singular_margin_alone():
    gait = replace(STRAIGHT.gait, amplitude=Interval(1.5, 1.5))
    limits = replace(STRAIGHT.limits, singularity=0.15)
    message = refused(replace(STRAIGHT, gait=gait, limits=limits))
    least = 0.236 * math.cos(1.5) + 0.0941
    assert f"lower the margin to {1e3 * least:.4g} mm" in message
    opened = replace(limits, singularity=least * 0.999)
    fine = maximize_speed(replace(STRAIGHT, gait=gait, limits=opened))
    assert fine.status is Status.OPTIMAL


def test_torque():
    gait = replace(STRAIGHT.gait, amplitude=Interval(0.5, 2.6), period=Interval(0.3, 1.0))
    limits = replace(STRAIGHT.limits, torque=0.001)
    problem = replace(STRAIGHT, gait=gait, limits=limits)
    message = refused(problem)
    assert "`torque`" in message
    needed = float(message.split("least peak torque is ")[1].split(" N m")[0])
    for factor, status in ((1.01, Status.OPTIMAL), (0.97, Status.INFEASIBLE)):
        opened = replace(limits, torque=needed * factor)
        assert maximize_speed(replace(problem, limits=opened)).status is status


def test_direction():
    gait = replace(STRAIGHT.gait, amplitude=Interval(0.4, 0.4), period=Interval(1.0, 2.0))
    message = refused(replace(STRAIGHT, gait=gait, direction="backward"))
    assert "`direction: backward`" in message
    assert "forward" in message


@pytest.mark.parametrize("direction", ["forward", "either"])
def test_the_same_gaits_are_fine_the_other_way(direction):
    gait = replace(STRAIGHT.gait, amplitude=Interval(0.4, 0.4), period=Interval(1.0, 2.0))
    optimum = maximize_speed(replace(STRAIGHT, gait=gait, direction=direction))
    assert optimum.status is Status.OPTIMAL
    assert optimum.best.gait.period == pytest.approx(1.0)
