"""A gait and its mirror image are one optimum, found for offsets of either sign."""

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import Interval


def test_offsets_of_either_sign():
    problem = PROBLEMS["turn_away"]
    left = replace(problem, gait=replace(problem.gait, offset=Interval(-0.6, -0.2)))
    one, other = maximize_speed(problem).best, maximize_speed(left).best
    assert other.speed == pytest.approx(one.speed, rel=1e-6)
    assert other.gait.offset == pytest.approx(-one.gait.offset, rel=1e-6)


def test_no_optimum_is_listed_with_its_mirror_image():
    offsets = [one.gait.offset for one in maximize_speed(PROBLEMS["low_friction_torque"]).optima]
    assert len({round(abs(offset), 2) for offset in offsets}) == len(offsets)
