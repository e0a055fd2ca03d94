"""Equation (3) with corrected signs is mechanics; with any other signs of the audit it is not."""

import numpy as np
import pytest
from hypothesis import find, given

from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle as integrated
from rr_paper.signs import CORRECTED, PRINTED, VARIANTS, energy_of, equation3, steady_cycle
from tests.mechanics.cases import FIRST_FOUND, REPEATABLE, cases, motion
from tests.robots import BENCHMARK

every_variant = pytest.mark.parametrize("signs", VARIANTS, ids=lambda one: one.name)
GAIT = SineGait(0.7, 1.0)


def off(case, signs):
    """|vdot by (3) - vdot| over their sizes."""
    robot, state = case
    slope, drive = equation3(robot, *state[1:], signs)
    expected = motion(robot, state).vdot
    return abs(slope * state.v + drive - expected) / (abs(slope * state.v) + abs(drive) + 1e-9)


@REPEATABLE
@given(cases())
def test_the_corrected_signs(case):
    assert off(case, CORRECTED) < 1e-9


@every_variant
def test_other_signs(signs):
    if signs is not CORRECTED:
        find(cases(), lambda case: off(case, signs) > 1e-2, settings=FIRST_FOUND)


@pytest.mark.parametrize("amplitude", [0.3, 0.9, 1.3])
def test_the_steady_speed_is_that_of_the_integrator(amplitude):
    expected = integrated(BENCHMARK, SineGait(amplitude, 1.2)).speed
    speed = steady_cycle(BENCHMARK, amplitude, 1.2).speed[0]
    assert speed == pytest.approx(expected, rel=1e-7)


def test_many_robots_and_gaits_at_once():
    robots, amplitudes, periods = [BENCHMARK, BENCHMARK], [0.4, 0.9], [1.0, 2.0]
    alone = [
        steady_cycle(BENCHMARK, alpha, T, PRINTED).speed[0]
        for alpha, T in zip(amplitudes, periods, strict=True)
    ]
    together = steady_cycle(robots, amplitudes, periods, PRINTED).speed
    np.testing.assert_allclose(together, alone, rtol=1e-12)


@every_variant
def test_the_energy_balance_closes(signs):
    energy = energy_of(BENCHMARK, GAIT, signs)
    assert abs(energy.gap) < 1e-9 * energy.friction
    assert energy.friction > 0


@every_variant
def test_only_the_corrected_signs_need_no_fictitious_force(signs):
    energy = energy_of(BENCHMARK, GAIT, signs)
    share = abs(energy.fictitious) / energy.friction
    assert share < 1e-9 if signs is CORRECTED else share > 1e-2
