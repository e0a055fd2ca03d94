"""What NumPy calls resolved is so: dry friction, whose speed converges by fits and starts."""

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from rr_opt.problem import Limits, Problem
from rr_opt.robot.parameters import EffectUse
from rr_opt.verify.doublings import Doublings
from rr_opt.verify.speeds import speeds
from rr_opt.verify.steady import Steady
from rr_opt.verify.steady_fourier import SteadyFourier
from tests.robots import BENCHMARK

LIMITS = Limits(angle=2.6, rate=99.0, torque=99.0)
USES = {
    "coulomb_friction": {"force1": 0.01, "force2": 0.01},
    "quadratic_drag": {"coefficient_total": 0.3},
}


@pytest.mark.parametrize("name", USES)
def test_within_a_millionth(name):
    robot = replace(BENCHMARK, physics=(EffectUse(name, USES[name]),))
    rng = np.random.default_rng(5)
    low, high = np.array([0.05, 0.3, -0.25]), np.array([1.2, 3.0, 0.25])
    alpha, T, phi0 = rng.uniform(low, high, (16, 3)).T
    with patch.object(SteadyFourier, "compiled", lambda *_: None):
        usual, fine = (
            speeds(Problem(robot, LIMITS), alpha, T, phi0, tolerance=tolerance).speed
            for tolerance in (1e-6, 1e-9)
        )
    known = np.isfinite(fine)
    assert known.sum() >= 12
    scale = np.maximum(np.abs(fine[known]), 1e-3)
    assert np.abs(usual[known] / scale - fine[known] / scale).max() <= 1e-6


def steady(speed: float, error: float = 1e-9) -> Steady:
    one = np.ones((1, 1))
    return Steady(speed * one, 0.0 * one, one, error * one, one)


def test_what_changed_last_counts_and_a_quarter_of_what_changed_before():
    doublings, rows = Doublings((1, 1)), np.array([0])
    errors = [doublings.error(rows, steady(v))[0, 0] for v in (1.0, 1.1, 1.1, 1.1)]
    assert errors[0] == np.inf
    assert errors[1:] == pytest.approx([0.1, 0.025, 0.0])


def test_no_error_is_known_right_after_no_cycle_was_found():
    doublings, rows = Doublings((1, 1)), np.array([0])
    errors = [
        doublings.error(rows, steady(1.0, error))[0, 0] for error in (1e-9, np.inf, 1e-9, 1e-9)
    ]
    assert errors == [np.inf, np.inf, np.inf, 0.0]
