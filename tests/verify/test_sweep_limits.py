"""A sweep has points on every line where a limit holds, and its best keeps all limits."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.ballast import Loads, load_count
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem, RatioChoice
from rr_opt.verify.grid import grid_of, points, reach
from rr_opt.verify.sweep import sweep
from tests.robots import BENCHMARK

PROBLEM = Problem(
    BENCHMARK,
    Limits(angle=1.6, rate=math.pi, torque=0.03),
    GaitBounds(Interval(0.1, 2.0), Interval(0.4, 3.0), Interval(-0.5, 0.5)),
)
COUNTS = {"amplitude": 7, "period": 9, "offset": 4}


@pytest.fixture(scope="module")
def found():
    return sweep(PROBLEM, COUNTS)


def test_bounds_are_points():
    grid = grid_of(PROBLEM, COUNTS)
    assert (grid.amplitude[0], grid.amplitude[-1]) == (0.1, 2.0)
    assert (grid.period[0], grid.period[-1]) == (0.4, 3.0)
    assert (grid.offset[0], grid.offset[-1]) == (0.0, 0.5)


def test_every_amplitude_has_its_fastest_period():
    amplitude, period, _, _ = points(PROBLEM, grid_of(PROBLEM, COUNTS))
    fastest = 2 * amplitude[..., 0]
    within = (fastest >= 0.4) & (fastest <= 3.0)
    on_line = np.isclose(period, fastest[..., None], rtol=1e-12).any(axis=-1)
    assert within.any()
    assert np.array_equal(on_line[within], np.ones(within.sum(), bool))


@pytest.mark.parametrize("singularity", [0.02, 0.10], ids=["angle", "singular posture"])
def test_every_offset_has_its_widest_amplitude(singularity):
    problem = replace(PROBLEM, limits=replace(PROBLEM.limits, singularity=singularity))
    amplitude, _, offset, _ = points(problem, grid_of(problem, COUNTS))
    widest = reach(problem) - np.abs(offset[0, :, 0, 0])
    there = np.isclose(amplitude[:, :, 0, 0], widest, rtol=1e-12).any(axis=0)
    assert there.all()


def test_points_just_keep_the_torque_limit(found):
    torque = found.found.peak_torque
    below = (torque > 0.03 * (1 - 1e-5)) & (torque <= 0.03)
    assert below.sum() > 5


def test_the_best_keeps_every_limit(found):
    for best in (found.best, found.refined):
        assert best.gait.peak_rate <= math.pi * (1 + 1e-7)
        assert best.gait.peak_angle <= 1.6 * (1 + 1e-7)
        assert best.peak_torque <= 0.03 * (1 + 1e-7)
    assert abs(found.refined.speed) >= abs(found.best.speed)


@pytest.mark.parametrize("direction", ["forward", "backward"])
def test_direction_is_kept(direction):
    wide = Limits(angle=2.6, rate=4 * math.pi, torque=1.0)
    found = sweep(replace(PROBLEM, limits=wide, direction=direction), COUNTS)
    assert found.refined is not None
    assert (found.refined.speed > 0) == (direction == "forward")


def test_only_whole_loads():
    choice = RatioChoice(Interval(0.1, 1.0), by="loads", loads=Loads(whole=True))
    result = sweep(replace(PROBLEM, inertia_ratio=choice), COUNTS)
    counts = [load_count(BENCHMARK, r, "joint", choice.loads) for r in result.found.decisions[3]]
    assert np.allclose(counts, np.round(counts), atol=1e-9)
    assert len(set(np.round(counts))) > 3


def test_bounds_that_leave_no_gait_give_no_best():
    tight = replace(PROBLEM, limits=replace(PROBLEM.limits, angle=0.05))
    result = sweep(tight, COUNTS)
    assert result.best is None
    assert result.refined is None


def test_where_no_point_keeps_the_other_limits_grip_is_kept_by_none():
    limits = replace(PROBLEM.limits, torque=1e-6, grip=0.4)
    assert sweep(replace(PROBLEM, limits=limits), COUNTS).best is None
