"""Random problems that were once refused, not solved or not confirmed are answered."""

import numpy as np
import pytest

import rr_opt as rr
from benchmarks.optimise.fourier_numpy import evaluate
from benchmarks.random.__main__ import turn
from benchmarks.random.problems import draw, problem
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.motion.steady_cycle import reference_cycle
from rr_opt.outcome import Status

SEED = "7a22e5445ca33a67"


@pytest.mark.parametrize(
    ("number", "radius", "speed"),
    [
        pytest.param(88, 0.363249, 5.95574e-4, id="rows that leave hardly any room"),
        pytest.param(104, 0.171269, 0.145617, id="a circle too tight for few phases"),
        pytest.param(149, -0.0411412, 9.434576e-5, id="a neighbour drives the other way"),
    ],
)
def test_turn(number: int, radius: float, speed: float) -> None:
    posed, *_ = turn(number, SEED)
    answer = rr.turn(posed, radius=radius)
    assert answer.status is Status.OPTIMAL, answer.message
    assert answer.speed is not None
    assert abs(answer.speed) == pytest.approx(speed, rel=1e-4)


@pytest.mark.parametrize("number", [111, 112])
def test_strong_friction(number: int) -> None:
    """Reference, optimiser and brute force agree on a robot that hardly gets on."""
    posed = problem(draw(SEED, number))
    optimum = maximize_speed(posed)
    best, robot = optimum.best, optimum.robot
    assert best is not None
    assert robot is not None
    assert reference_cycle(robot, best.gait).speed == pytest.approx(best.speed, rel=1e-7, abs=0)
    gait = [best.gait.amplitude, best.gait.period, best.gait.offset, optimum.ratio or 0.0]
    known = evaluate(posed.robot, posed.inertia_ratio, gait, nodes=384)
    np.testing.assert_allclose(known.speed, best.speed, rtol=1e-6)
