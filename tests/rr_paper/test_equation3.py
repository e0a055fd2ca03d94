"""Equation (3) with corrected signs is mechanics; with any other signs of the audit it is not."""

import pytest
from hypothesis import find, given

from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from rr_paper.equation3 import CORRECTED, VARIANTS, equation3, steady
from tests.mechanics.cases import FIRST_FOUND, REPEATABLE, cases, motion
from tests.robots import BENCHMARK


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


@pytest.mark.parametrize(
    "signs", [one for one in VARIANTS if one is not CORRECTED], ids=lambda one: one.name
)
def test_other_signs(signs):
    find(cases(), lambda case: off(case, signs) > 1e-2, settings=FIRST_FOUND)


@pytest.mark.parametrize("amplitude", [0.3, 0.9, 1.3])
def test_the_steady_speed(amplitude):
    gait = SineGait(amplitude, 1.2)
    expected = steady_cycle(BENCHMARK, gait).speed
    assert steady(BENCHMARK, gait, CORRECTED).speed == pytest.approx(expected, rel=1e-7)
