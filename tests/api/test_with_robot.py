"""A problem with another robot keeps its limits, as far as that robot's servo can reach them."""

import math
from dataclasses import replace

import pytest

import rr_opt as rr


def test_limits_follow_a_weaker_servo_and_no_stronger_one():
    problem = rr.Problem(rr.prototype(), rr.Limits(rate="20 rpm"))
    weak = replace(rr.prototype(), servo=rr.Servo(rate_limit="10 rpm", torque_limit=0.5))
    strong = replace(rr.prototype(), servo=rr.Servo(rate_limit="90 rpm", torque_limit=9.0))
    assert problem.with_robot(weak).limits.rate == pytest.approx(math.pi / 3)
    assert problem.with_robot(weak).limits.torque == 0.5
    assert problem.with_robot(strong).limits == problem.limits
    assert problem.with_robot(weak).robot is weak


def test_loads_start_at_the_new_robot():
    choice = rr.RatioChoice((0.08, 0.3), by="loads")
    problem = rr.Problem(rr.prototype(), inertia_ratio=choice)
    heavy = replace(rr.prototype(), platform2=replace(rr.prototype().platform2, I=0.0040))
    low = problem.with_robot(heavy).inertia_ratio.bounds.low
    assert low > 0.2


def test_the_fingerprint_is_not_that_of_the_file():
    shipped = rr.shipped()
    assert len(shipped.sha256) == 64
    assert shipped.with_robot(shipped.robot).sha256 == ""
