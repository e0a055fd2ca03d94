"""A gait that sits where forward turns into backward is told, as its direction is a convention."""

import math

from benchmarks.optimise.problems import CENTRE, PROBLEMS, WIDE, gait, limits, robot
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import Problem


def test_told():
    # Without a rate limit the heading swings by 2.4 rad, and the mean heading all but vanishes.
    problem = Problem(robot(), limits(1.5, math.inf), gait(WIDE), CENTRE, "backward")
    assert maximize_speed(problem).sideways


def test_not_told_of_others():
    assert not maximize_speed(PROBLEMS["paper"]).sideways
