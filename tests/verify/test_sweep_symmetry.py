"""The sweep's speeds know neither left from right nor where a cycle begins, and do not jump
where the half-period method for straight gaits takes over from that for all gaits."""

import numpy as np
import pytest

from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify.speeds import speeds
from rr_opt.verify.steady_fourier import SteadyFourier
from tests.robots import BENCHMARK, DRY

LIMITS = Limits(angle=2.6, rate=4.0, torque=1.5)
AMPLITUDES, PERIODS = np.linspace(0.1, 1.2, 6)[:, None], np.linspace(0.5, 2.5, 5)


@pytest.mark.parametrize("offset", [0.01, 0.3, 0.6])
def test_mirror_images_go_equally_fast(offset):
    # phi0 and -phi0 are the same gait in the mirror, half a period later.
    left, right = (
        speeds(Problem(BENCHMARK, LIMITS), AMPLITUDES, PERIODS, side * offset) for side in (1, -1)
    )
    assert left.converged.all()
    assert left.speed == pytest.approx(right.speed, rel=1e-7, abs=1e-10)
    assert left.turn == pytest.approx(-right.turn, rel=1e-7, abs=1e-10)
    assert left.peak_torque == pytest.approx(right.peak_torque, rel=1e-6)


@pytest.mark.parametrize("robot", [BENCHMARK, DRY], ids=["viscous", "dry"])
def test_half_a_period_says_everything(robot: Robot):
    dynamics = dynamics_of(robot)
    model, p = SteadyFourier(dynamics), dynamics.values(robot)[:, None]
    shape = np.array([0.9]), np.array([0.0]), np.array([[0.8, 1.6]])
    half, whole = (model.cycles(*shape, p, n, n == 1024) for n in (1024, 2048))
    assert half.speed == pytest.approx(whole.speed, rel=1e-8)
    assert half.peak_torque == pytest.approx(whole.peak_torque, rel=1e-6)
    assert whole.turn == pytest.approx(0.0, abs=1e-12)


def test_no_jump_from_straight_to_turning():
    offsets = np.concatenate([[0.0], np.logspace(-9, 0, 19)])
    found = speeds(Problem(BENCHMARK, LIMITS), 0.7, 1.4, offsets)
    # An even function of the offset: it leaves its value at 0 with the offset's square.
    change = np.abs(found.speed / found.speed[0] - 1)
    assert np.all(change <= 20 * offsets**2 + 1e-7)
    assert np.all(np.diff(np.abs(found.turn)) > 0)


def test_a_product_grid_is_its_points():
    choice = Problem(BENCHMARK, LIMITS)
    grid = speeds(choice, AMPLITUDES, PERIODS, 0.2)
    alpha, T = np.broadcast_arrays(AMPLITUDES, PERIODS)
    listed = speeds(choice, alpha.ravel(), T.ravel(), np.full(alpha.size, 0.2))
    assert grid.speed.ravel() == pytest.approx(listed.speed, rel=1e-6)
