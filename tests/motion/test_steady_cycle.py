"""The steady cycle is the state that a long simulation by cvodes settles to."""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.integrators import cvodes
from rr_opt.motion.steady_cycle import reference_cycle, steady_cycle
from rr_opt.outcome import NotConvergedError
from tests.robots import BENCHMARK, DRY, with_friction

GAITS = [SineGait(0.7, 1.4), SineGait(1.2, 2.4, 0.5), SineGait(0.4, 0.8, -0.3)]


@pytest.mark.parametrize("gait", GAITS)
@pytest.mark.parametrize("robot", [BENCHMARK, DRY], ids=["viscous", "dry"])
def test_long_simulation_settles_to_it(robot, gait):
    steady = steady_cycle(robot, gait, steps=2048)
    cycles = 100
    settled = cvodes(robot, gait, 0.0, np.array([0.0, cycles * gait.period]))[0, -1]
    assert settled == pytest.approx(steady.v[0], abs=2e-5)


@pytest.mark.parametrize("gait", GAITS)
@pytest.mark.parametrize(("robot", "within"), [(BENCHMARK, 1e-8), (DRY, 1e-5)])
def test_fixed_steps_agree_with_cvodes(robot, within, gait):
    fixed, reference = steady_cycle(robot, gait), reference_cycle(robot, gait)
    assert fixed.speed == pytest.approx(reference.speed, rel=within)


def test_cycle_closes():
    steady = reference_cycle(BENCHMARK, GAITS[1])
    assert steady.v[-1] == pytest.approx(steady.v[0], rel=1e-9)


def test_no_friction_has_no_cycle():
    with pytest.raises(NotConvergedError, match="needs friction"):
        steady_cycle(with_friction(0.0), GAITS[0])


def test_singular_posture_has_no_cycle():
    with pytest.raises(NotConvergedError, match="singular posture"):
        steady_cycle(BENCHMARK, SineGait(2.5, 3.0))
