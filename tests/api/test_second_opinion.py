"""What the sweep finds and the optimiser missed becomes the answer; refusals have two witnesses."""

from dataclasses import replace

import pytest

import rr_opt as rr
from benchmarks.optimise.problems import PROBLEMS
from rr_opt.api import optimise
from rr_opt.design.maximize_speed import Optimum
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from rr_opt.outcome import Status

PROBLEM = PROBLEMS["reference"]
FIND = optimise.design.maximize_speed


@pytest.fixture(scope="module")
def right():
    return rr.maximize_speed(PROBLEM)


@pytest.mark.parametrize("status", [Status.INFEASIBLE, Status.NOT_CONVERGED])
def test_a_gait_that_was_missed(right, status, monkeypatch):
    monkeypatch.setattr(
        optimise.design, "maximize_speed", lambda problem, *_: Optimum(status, "None.", problem)
    )
    found = rr.maximize_speed(PROBLEM)
    assert found.status is Status.OPTIMAL
    assert found.speed == pytest.approx(right.speed, rel=1e-6)


def test_an_optimum_that_is_slower_than_another(right, monkeypatch):
    def elsewhere(problem, *_):
        best = right.optimum.best
        gait = SineGait(0.9 * best.gait.amplitude, best.gait.period, best.gait.offset)
        return replace(right.optimum, best=replace(best, gait=gait, speed=0.8 * best.speed))

    monkeypatch.setattr(optimise.design, "maximize_speed", elsewhere)
    found = rr.maximize_speed(PROBLEM)
    assert found.status is Status.OPTIMAL
    assert found.speed == pytest.approx(right.speed, rel=1e-6)


def test_a_refusal_reports_both_scans():
    tight = replace(PROBLEM, limits=replace(PROBLEM.limits, torque=1e-6))
    refused = rr.maximize_speed(tight)
    assert refused.status is Status.INFEASIBLE
    assert "This is based on" in refused.message
    assert "with another model finds none either" in refused.message


def test_limits_that_clash_need_no_scan():
    tight = replace(PROBLEM, limits=replace(PROBLEM.limits, rate=1e-3))
    refused = rr.maximize_speed(tight)
    assert refused.status is Status.INFEASIBLE
    assert "sweep" not in refused.message


def test_shapes_are_compared_with_what_the_servo_can_do(monkeypatch):
    """Its rate limit lies below the problem's, within which the sweep would find faster sines."""
    slow = (EffectUse("servo_rate_limit", {"rate_limit": 0.7 * PROBLEM.limits.rate}),)
    monkeypatch.setattr(optimise.design, "compare_shapes", lambda problem, *_: [FIND(problem)])
    found = rr.shapes(replace(PROBLEM, robot=replace(PROBLEM.robot, physics=slow)))
    assert found.status is Status.OPTIMAL, found.message
