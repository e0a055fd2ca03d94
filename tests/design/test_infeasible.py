"""A problem without a feasible gait names the limits that conflict and how far each must change."""

import math
from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import Interval
from rr_opt.outcome import Status

STRAIGHT = PROBLEMS["straight"]


def refused(problem):
    optimum = maximize_speed(problem)
    assert optimum.status is Status.INFEASIBLE
    assert optimum.best is None
    return optimum.message


def told(message, before, after):
    """The number that a message gives between two texts."""
    return float(message.split(before)[1].split(after)[0])


def test_rate():
    gait = replace(STRAIGHT.gait, amplitude=Interval(1.2, 1.2), period=Interval(0.5, 1.0))
    problem = replace(STRAIGHT, gait=gait)
    message = refused(problem)
    assert "`rate`" in message
    enough = told(message, "raise the limit to ", " rad/s")
    assert enough == pytest.approx(2.4 * math.pi, rel=1e-5)
    opened = replace(STRAIGHT.limits, rate=enough)
    assert maximize_speed(replace(problem, limits=opened)).status is Status.OPTIMAL
    slower = Interval(0.5, told(message, "the period's bound to ", " s,"))
    opened = replace(problem, gait=replace(gait, period=slower))
    assert maximize_speed(opened).status is Status.OPTIMAL


def test_angle_given_exactly_as_told():
    limits = replace(STRAIGHT.limits, angle=0.02)
    message = refused(replace(STRAIGHT, limits=limits))
    enough = told(message, "raise the limit to ", " rad")
    optimum = maximize_speed(replace(STRAIGHT, limits=replace(limits, angle=enough)))
    assert optimum.status is Status.OPTIMAL
    # All that is left free is found: the period by the rate, the ratio by its bound.
    assert optimum.best.gait.amplitude == pytest.approx(0.05)
    assert optimum.ratio == pytest.approx(0.08, rel=1e-4)


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
    least = told(message, "lower the margin to ", " mm") / 1e3
    assert least == pytest.approx(0.236 * math.cos(1.5) + 0.0941, rel=1e-5)
    opened = replace(limits, singularity=least)
    fine = maximize_speed(replace(STRAIGHT, gait=gait, limits=opened))
    assert fine.status is Status.OPTIMAL


def test_more_margin_than_the_robot_has():
    limits = replace(STRAIGHT.limits, singularity=0.4)
    message = refused(replace(STRAIGHT, limits=limits))
    assert "is more than the robot has: at phi = 0, S1 is 330.1 mm" in message


def test_everything_fixed():
    gait = replace(STRAIGHT.gait, amplitude=Interval(0.4, 0.4), period=Interval(1.2, 1.2))
    problem = replace(STRAIGHT, gait=gait, inertia_ratio=None, direction="either")
    optimum = maximize_speed(problem)
    assert optimum.status is Status.OPTIMAL
    assert optimum.best.gait.amplitude == pytest.approx(0.4)


def test_torque():
    gait = replace(STRAIGHT.gait, amplitude=Interval(0.5, 2.6), period=Interval(0.3, 1.0))
    limits = replace(STRAIGHT.limits, torque=0.001)
    problem = replace(STRAIGHT, gait=gait, limits=limits)
    message = refused(problem)
    assert "`torque`" in message
    needed = told(message, "least peak torque is ", " N m")
    for factor, status in ((1.0, Status.OPTIMAL), (0.97, Status.INFEASIBLE)):
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
