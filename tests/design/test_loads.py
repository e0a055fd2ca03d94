"""Loads change mass, centre and inertia together, and can be asked to come whole."""

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.ballast import inertia_ratio, load_count

PROBLEM = PROBLEMS["paper_loads"]


def with_loads(**changes):
    choice = PROBLEM.inertia_ratio
    return replace(PROBLEM, inertia_ratio=replace(choice, loads=replace(choice.loads, **changes)))


def test_the_robot_carries_them():
    optimum = maximize_speed(PROBLEM)
    count = load_count(PROBLEM.robot, optimum.ratio, "joint", PROBLEM.inertia_ratio.loads)
    assert optimum.robot.platform2.m == pytest.approx(0.250 + 0.066 * count)
    assert inertia_ratio(optimum.robot, "joint") == pytest.approx(optimum.ratio)


def test_whole_loads():
    free, whole = maximize_speed(PROBLEM), maximize_speed(with_loads(whole=True))
    count = load_count(PROBLEM.robot, whole.ratio, "joint", PROBLEM.inertia_ratio.loads)
    assert count == pytest.approx(round(count), abs=1e-6)
    assert abs(whole.best.speed) <= abs(free.best.speed) * (1 + 1e-6)
