"""A rollout from the steady state repeats the steady cycle, moved rigidly from period to period."""

import numpy as np
import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.model.gait import SineGait
from rr_opt.motion.rollout import repeated, rollout
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import InputError


@pytest.fixture(scope="module")
def robot():
    return read_problem(None).robot


@pytest.mark.parametrize("offset", [0.0, 0.3])
def test_driving_on_is_repeating(robot, offset):
    gait = SineGait(0.6, 0.8, offset)
    driven = rollout(robot, gait, 3 * gait.period, "steady", 64 / gait.period)
    again = repeated(steady_cycle(robot, gait, steps=64 * 4), 3)
    for name in ("t", "x", "y", "psi", "phi", "v", "torque"):
        assert np.allclose(getattr(driven, name), getattr(again, name)[::4], atol=1e-8), name
    fewer = repeated(steady_cycle(robot, gait, steps=64 * 4), 3, every=4)
    for name in ("t", "x", "y", "psi", "phi", "v", "torque"):
        assert np.allclose(getattr(fewer, name), getattr(again, name)[::4], atol=1e-12), name


def test_rest_settles_to_the_steady_state(robot):
    gait = SineGait(0.6, 0.8, 0.0)
    driven = rollout(robot, gait, 40.0, "rest", 100.0)
    steady = steady_cycle(robot, gait)
    assert driven.v[0] == 0
    assert driven.v[-1] == pytest.approx(steady.v[0], rel=1e-6)


@pytest.mark.parametrize(
    ("amplitude", "seconds", "rate", "word"),
    [(1.9, 1.0, 100.0, "singular"), (0.5, 0.0, 100.0, "samples"), (0.5, 1e9, 1e9, "samples")],
)
def test_what_cannot_be_driven_is_told(robot, amplitude, seconds, rate, word):
    with pytest.raises(InputError, match=word):
        rollout(robot, SineGait(amplitude, 1.0), seconds, "rest", rate)
