"""Servo, friction and the force from nowhere balance; with corrected signs nothing is nowhere."""

import pytest

from rr_opt.model.gait import SineGait
from rr_paper.equation3 import CORRECTED, VARIANTS, energy_of
from tests.robots import BENCHMARK

GAIT = SineGait(0.7, 1.0)


@pytest.mark.parametrize("signs", VARIANTS, ids=lambda one: one.name)
def test_the_books_close(signs):
    energy = energy_of(BENCHMARK, GAIT, signs)
    assert abs(energy.gap) < 1e-9 * energy.friction
    assert energy.friction > 0


@pytest.mark.parametrize("signs", VARIANTS, ids=lambda one: one.name)
def test_only_the_corrected_signs_need_no_push(signs):
    energy = energy_of(BENCHMARK, GAIT, signs)
    share = abs(energy.nowhere) / energy.friction
    assert share < 1e-9 if signs is CORRECTED else share > 1e-2
