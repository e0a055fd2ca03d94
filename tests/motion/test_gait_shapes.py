"""Gaits of every shape are integrated alike: by either method, and shapes that meet move alike."""

import numpy as np
import pytest

from rr_opt.mechanics.runge_kutta import BUTCHER6, RK4
from rr_opt.model.gait import FourierGait
from rr_opt.motion.integrators import cvodes, fixed_steps, whole_steps
from rr_opt.motion.rollout import repeated, rollout
from rr_opt.motion.steady_cycle import reference_cycle, steady_cycle
from tests.motion.gaits import EVERY, FREE, SINE, free_sine
from tests.robots import BENCHMARK, DRY

SHAPES = pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)


@SHAPES
@pytest.mark.parametrize(("robot", "within"), [(BENCHMARK, 1e-8), (DRY, 1e-5)])
def test_fixed_steps_agree_with_cvodes(robot, within, gait):
    fixed, reference = steady_cycle(robot, gait), reference_cycle(robot, gait)
    assert fixed.speed == pytest.approx(reference.speed, rel=within)
    assert fixed.cycle.dpsi == pytest.approx(reference.cycle.dpsi, rel=within, abs=1e-10)


@pytest.mark.parametrize(("method", "steps"), [(RK4, 96), (BUTCHER6, 48)])
def test_a_jump_does_not_cost_the_order(method, steps):
    def end(n, method):
        return fixed_steps(BENCHMARK, FREE, 0.1, steps=n, method=method)[:, -1]

    truth = end(3200, BUTCHER6)
    errors = [np.abs(end(n, method) - truth).max() for n in (steps, 2 * steps)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(method.order, abs=0.2)


@pytest.mark.parametrize("steps", [1, 16, 17, 512])
def test_steps_meet_every_jump(steps):
    n = whole_steps(FREE, steps)
    assert n >= steps
    assert n % FREE.pieces == 0
    assert fixed_steps(BENCHMARK, FREE, 0.0, steps=steps).shape == (5, n + 1)


def test_one_harmonic_moves_as_the_sine():
    same = FourierGait(SINE.period, SINE.offset, (SINE.amplitude,), (0.0,))
    one, other = steady_cycle(BENCHMARK, SINE), steady_cycle(BENCHMARK, same)
    for name in ("v", "psi", "x", "y", "torque"):
        assert np.allclose(getattr(one, name), getattr(other, name), rtol=0, atol=1e-12), name


def test_a_free_gait_tends_to_the_sine_with_order_2():
    truth = steady_cycle(BENCHMARK, SINE)
    errors = [
        abs(steady_cycle(BENCHMARK, free_sine(SINE, n)).speed - truth.speed) for n in (48, 96, 192)
    ]
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert slopes == pytest.approx(2, abs=0.1)
    assert errors[-1] < 1e-3 * abs(truth.speed)


@SHAPES
def test_a_rollout_repeats_the_steady_cycle(gait):
    rate = 480 / gait.period
    driven = rollout(BENCHMARK, gait, 2 * gait.period, "steady", rate)
    again = repeated(steady_cycle(BENCHMARK, gait, steps=480), 2)
    for name in ("t", "x", "y", "psi", "phi", "v", "torque"):
        assert np.allclose(getattr(driven, name), getattr(again, name), atol=1e-8), name


def test_samples_may_lie_anywhere_between_the_jumps():
    times = np.array([0.0, 0.01, 0.3, 0.30001, FREE.period, 2.5 * FREE.period, 5.0])
    alone = [cvodes(BENCHMARK, FREE, 0.1, [0.0, t])[:, -1] for t in times[1:]]
    together = cvodes(BENCHMARK, FREE, 0.1, times)[:, 1:]
    assert np.allclose(np.transpose(alone), together, rtol=0, atol=1e-10)
