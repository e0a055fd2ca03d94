"""A row of a study is optimal only if its gait keeps every limit, between samples too."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.design.study.case import measured
from rr_opt.files.problem_file import read_problem
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.motion.steady_cycle import reference_cycle
from rr_opt.outcome import Status


@pytest.fixture(scope="module")
def solved():
    shipped = read_problem(None)
    gait = GaitBounds(Interval(0.1, 1.2), Interval(0.8, 1.6))
    return maximize_speed(Problem(shipped.robot, shipped.limits, gait))


@pytest.fixture(scope="module")
def extremes(solved):
    """Of the winner, by a simulation at tight tolerance and fine samples."""
    steady = reference_cycle(solved.robot, solved.best.gait, samples=20_000)
    robot = solved.robot
    return {
        "angle": np.abs(steady.phi).max(),
        "rate": np.abs(np.gradient(steady.phi, steady.t, edge_order=2)).max(),
        "torque": np.abs(steady.torque).max(),
        "singularity": (robot.platform1.c * np.cos(steady.phi) + robot.platform2.c).min(),
    }


@pytest.mark.parametrize("name", ["angle", "rate", "torque", "singularity"])
@pytest.mark.parametrize(("excess", "status"), [(2e-4, "not_converged"), (5e-5, "optimal")])
def test_status_says_whether_a_limit_is_kept(solved, extremes, name, excess, status):
    side = 1 + excess if name == "singularity" else 1 - excess
    limits = replace(solved.problem.limits, **{name: float(extremes[name]) * side})
    problem = replace(solved.problem, limits=limits)
    row = measured(problem, solved.best, solved.robot, solved.ratio)
    assert row.status == Status(status)
    assert (row.optimum is None) == (status != "optimal")
    if status != "optimal":
        assert f"limit on {name}" in row.message
        assert "2.0e-04 of it" in row.message
