"""How softly dry friction sets in: with tanh(u/onset), and over what it does in 5 ms."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.robot import EffectUse
from tests.mechanics.cases import State
from tests.mechanics.floor import on_floor
from tests.robots import BENCHMARK

FORCE, SLOW = 0.002, 0.0015
MASS = BENCHMARK.platform1.m + BENCHMARK.platform2.m


def slowed(**onset):
    """m/s2, by dry friction alone, of a straight robot that rolls slowly."""
    values = {"force1": FORCE, "force2": FORCE, **onset}
    state, place = State(SLOW, 0.0, 0.0, 0.0), np.zeros(3)
    dry = replace(BENCHMARK, physics=(EffectUse("coulomb_friction", values),))
    return on_floor(BENCHMARK, state, place).speeds[0] - on_floor(dry, state, place).speeds[0]


@pytest.mark.parametrize("onset", [2e-4, 1e-3, 5e-3])
def test_as_the_speed_over_the_onset(onset):
    softened = onset + 0.005 * 4 * FORCE / MASS
    assert slowed(onset=onset) == pytest.approx(4 * FORCE / MASS * math.tanh(SLOW / softened))


def test_two_millimetres_a_second_if_not_given():
    assert slowed() == pytest.approx(slowed(onset=2e-3))
