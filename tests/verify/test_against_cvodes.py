"""The sweep's Fourier model gives the speed, turn and peak torque that cvodes gives."""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Limits, Problem
from rr_opt.motion.steady_cycle import reference_cycle
from rr_opt.verify.speeds import speeds
from tests.robots import BENCHMARK, DRY

LIMITS = Limits(angle=2.6, rate=4.0, torque=1.5)
GAITS = [
    SineGait(0.7, 1.4),
    SineGait(1.2, 2.4, 0.5),
    SineGait(0.4, 0.8, -0.3),
    SineGait(1.75, 2.9),  # S1 comes down to 5 cm
    SineGait(0.05, 0.3, 1e-6),
]


@pytest.mark.parametrize("gait", GAITS, ids=str)
@pytest.mark.parametrize(
    ("robot", "asked"), [(BENCHMARK, 1e-6), (DRY, 1e-7)], ids=["viscous", "dry"]
)
def test_one_gait(robot, asked, gait):
    # The harmonics of dry friction fall off slowly, and what is left of them is underestimated.
    reference = reference_cycle(robot, gait)
    found = speeds(Problem(robot, LIMITS), gait.amplitude, gait.period, gait.offset, None, asked)
    assert np.all(found.converged)
    assert float(found.speed) == pytest.approx(reference.speed, rel=1e-6)
    assert float(found.turn) == pytest.approx(reference.cycle.dpsi, rel=1e-6, abs=1e-9)
    torque = np.abs(reference.torque).max()
    assert float(found.peak_torque) == pytest.approx(torque, rel=1e-4)


def test_mirror_images():
    problem = Problem(BENCHMARK, LIMITS)
    left, right = (speeds(problem, 0.9, 1.8, sign * 0.4) for sign in (1, -1))
    assert float(left.speed) == pytest.approx(float(right.speed), rel=1e-9)
    assert float(left.turn) == pytest.approx(-float(right.turn), rel=1e-9)


def test_no_jump_towards_straight():
    offsets = np.concatenate([[0.0], np.logspace(-9, 0, 19)])
    found = speeds(Problem(BENCHMARK, LIMITS), 0.7, 1.4, offsets)
    assert np.all(np.abs(found.speed - found.speed[0]) <= 2 * offsets**2 + 1e-7)
