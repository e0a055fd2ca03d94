"""Robots that friction stops within a small part of a period are resolved too."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.motion.steady_cycle import reference_cycle, steady_cycle
from rr_opt.verify.speeds import speeds
from tests.robots import BENCHMARK


@pytest.mark.parametrize("offset", [0.0, 0.2])
@pytest.mark.parametrize("kappa", [1e-3, 1e-2, 0.1])
def test_speed_is_that_of_the_integrator(kappa, offset):
    one, two = (replace(part, kappa=kappa) for part in (BENCHMARK.platform1, BENCHMARK.platform2))
    robot = replace(BENCHMARK, platform1=one, platform2=two)
    found = speeds(Problem(robot), 1.0, 1.5, offset)
    cycle = steady_cycle(robot, SineGait(1.0, 1.5, offset), steps=6144).cycle
    assert np.isfinite(found.speed)
    assert float(found.speed) == pytest.approx(cycle.speed, rel=1e-5)
    assert float(found.turn) == pytest.approx(cycle.dpsi, rel=1e-5, abs=1e-9)


def test_a_light_robot_is_resolved_or_reported_as_unresolved():
    one, two = (
        replace(part, kappa=0.1, m=0.1 * part.m, I=0.1 * part.I)
        for part in (BENCHMARK.platform1, BENCHMARK.platform2)
    )
    robot = replace(BENCHMARK, platform1=one, platform2=two)
    found = float(speeds(Problem(robot), 1.3, 3.0, 0.2).speed)
    cycle = steady_cycle(robot, SineGait(1.3, 3.0, 0.2), steps=24576).cycle
    assert np.isnan(found) or found == pytest.approx(cycle.speed, rel=1e-4)


@pytest.mark.parametrize("offset", [0.0, 0.3])
@pytest.mark.parametrize("k", [300.0, 1000.0])
def test_wheels_that_hardly_roll(k, offset):
    """Friction that lets a robot go no further than a thousandth of a period without its gait."""
    one, two = (
        replace(part, kappa=k * BENCHMARK.h**2)
        for part in (BENCHMARK.platform1, BENCHMARK.platform2)
    )
    robot, gait = replace(BENCHMARK, platform1=one, platform2=two), SineGait(0.7, 1.6, offset)
    known = reference_cycle(robot, gait)
    assert steady_cycle(robot, gait).speed == pytest.approx(known.speed, rel=1e-6)
    found = speeds(Problem(robot), gait.amplitude, gait.period, offset, tolerance=1e-8)
    assert found.converged
    assert float(found.speed) == pytest.approx(known.speed, rel=1e-6)
    many = speeds(Problem(robot), np.full(30_000, 0.7), 1.6, offset, tolerance=1e-6)
    np.testing.assert_allclose(many.speed, known.speed, rtol=1e-5)
