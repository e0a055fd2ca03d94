"""How softly dry friction sets in: with tanh(u/onset), and over what it does in 2 ms."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer.drive import _SHARP
from rr_opt.model.robot import EffectUse
from tests.mechanics.cases import State
from tests.mechanics.floor import on_floor
from tests.robots import BENCHMARK

FORCE, SLOW = 0.002, 0.0015
MASS = BENCHMARK.platform1.m + BENCHMARK.platform2.m


def slowed(speed=SLOW, phi=0.0, **values):
    """m/s2, by dry friction alone, of a robot that rolls slowly, its joint at rest."""
    state, place = State(speed, phi, 0.0, 0.0), np.zeros(3)
    given = {"force1": FORCE, "force2": FORCE, **values}
    dry = replace(BENCHMARK, physics=(EffectUse("coulomb_friction", given),))
    return on_floor(BENCHMARK, state, place).speeds[0] - on_floor(dry, state, place).speeds[0]


@pytest.mark.parametrize("onset", [2e-4, 1e-3, 5e-3])
def test_as_the_speed_over_the_onset(onset):
    softened = onset + 0.002 * 4 * FORCE / MASS
    assert slowed(onset=onset) == pytest.approx(4 * FORCE / MASS * math.tanh(SLOW / softened))


def test_two_millimetres_a_second_if_not_given():
    assert slowed() == pytest.approx(slowed(onset=2e-3))


@pytest.mark.parametrize("phi", [0.0, 0.8, 1.6])
@pytest.mark.parametrize("force", [1e-3, 10.0])
def test_the_longest_step_is_stable(force, phi):
    slow = 1e-9
    slope = slowed(slow, phi, force1=force, force2=force, onset=2e-4) / slow
    assert slope * _SHARP < 2.0  # of 2.78, where steps of order 4 become unstable
