"""What NumPy calls resolved is so: dry friction, whose speed converges by fits and starts."""

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import EffectUse
from rr_opt.verify.compiled_cycles import Steady
from rr_opt.verify.speeds import speeds
from rr_opt.verify.steady_fourier import Doublings, SteadyFourier
from tests.robots import BENCHMARK

LIMITS = Limits(angle=2.6, rate=99.0, torque=99.0)
DRY = EffectUse("coulomb_friction", {"force1": 0.01, "force2": 0.01})
CHANCES = np.array(
    [
        [1.5297340917440718, 0.36012387583510364, 0.08221486465030015, 0.3052681653919679],
        [1.5575406625309114, 1.015015776289371, 0.014934378436503581, 0.35010986100236596],
    ]
)
"""Gaits (alpha, T, phi0, J20/J10) where two counts of samples agree by chance: a fall between
neighbouring harmonics, taken for the error, was 10 and 1.3 millionths short of the truth."""


SPEEDS = [0.300140938194, -0.183845144757]
"""m/s, by machine code, to a thousandth of a millionth."""


def by_numpy(tolerance):
    problem = Problem(replace(BENCHMARK, physics=(DRY,)), LIMITS)
    with patch.object(SteadyFourier, "compiled", lambda *_: None):
        return speeds(problem, *CHANCES.T, tolerance=tolerance)


def test_within_a_millionth():
    assert by_numpy(1e-6).speed == pytest.approx(SPEEDS, rel=1e-6)


def test_what_needs_more_samples_than_there_are_has_no_speed():
    found = by_numpy(1e-12)
    assert not found.converged[0]
    assert np.isnan(found.speed[0])


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
