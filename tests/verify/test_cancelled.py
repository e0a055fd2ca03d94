"""A mean speed that is the little that is left of the way to and fro is checked as exactly as the
largest speed along the cycle is known."""

import numpy as np
import pytest

from benchmarks.random.problems import draw, turning
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import CANCELLED
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.results.fastest import LARGEST_REPLAY_ERROR
from rr_opt.verify.replay import replay
from rr_opt.verify.speeds import robot_with
from rr_opt.verify.sweep import TOLERATED, check_optimum, sweep

POSED = turning(draw("e241d9f31a242ca6", 77_000))
RATIO = 1.9795669735851291
GAIT = SineGait(0.8115, 0.8733288308376043, -0.3154)


@pytest.fixture(scope="module")
def cycle():
    return steady_cycle(robot_with(POSED, RATIO), GAIT, steps=4096)


def test_replay(cycle):
    scale = CANCELLED * np.abs(cycle.v).max()
    assert abs(cycle.speed) < 0.1 * scale
    robot, limits = robot_with(POSED, RATIO), POSED.limits
    near, far = (
        replay(robot, GAIT, limits, cycle.speed + away * LARGEST_REPLAY_ERROR * scale)
        for away in (0.5, 2.0)
    )
    assert LARGEST_REPLAY_ERROR < near.error <= LARGEST_REPLAY_ERROR * near.allowance
    assert far.error > LARGEST_REPLAY_ERROR * far.allowance


def test_sweep(cycle):
    everywhere = sweep(POSED)
    scale = CANCELLED * np.abs(cycle.v).max()
    near, far = (
        check_optimum(POSED, GAIT, RATIO, cycle.speed + away * scale, everywhere=everywhere)
        for away in (0.9 * TOLERATED, 1.1 * TOLERATED)
    )
    assert TOLERATED < near.error <= near.largest_error
    assert far.error > far.largest_error
    assert near.better is not None
