"""A circle so tight that the mean velocity nearly vanishes is found, and not refused."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem, RatioChoice, Turn
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.steady_cycle import steady_cycle

H2 = 0.02**2
ROBOT = Robot(
    Platform(0.4956, 0.005232, 0.2724, 0.04938, 0.02212, 0.02476 * H2),
    Platform(0.6276, 0.003187, 0.1267, 0.01083, 0.06133, 0.03503 * H2),
    0.02,
)
PROBLEM = Problem(
    ROBOT,
    Limits(2.146, 4.466, 0.7181, 0.03),
    GaitBounds(Interval(0.05, 1.75), Interval(0.37, 2.45), Interval(-0.408, 0.408)),
    RatioChoice(Interval(0.4968, 1.124), about="centre"),
    "backward",
)
RADIUS = -0.03237


def asked(radius):
    return replace(PROBLEM, turn=Turn(curvature=Interval(1 / radius, 1 / radius)))


def test_it_is_found():
    optimum = maximize_speed(asked(RADIUS))
    assert optimum.best is not None, optimum.message
    assert optimum.best.speed == pytest.approx(-0.0146877, rel=1e-5)
    cycle = steady_cycle(optimum.robot, optimum.best.gait).cycle
    assert cycle.dpsi / cycle.period / abs(cycle.speed) == pytest.approx(1 / RADIUS, rel=1e-6)


def test_a_hair_wider_is_worth_what_its_price_says():
    prices, speeds = [], []
    for radius in (RADIUS * (1 - 1e-5), RADIUS * (1 + 1e-5)):
        optimum = maximize_speed(asked(radius))
        prices.append(optimum.best.prices["curvature"])
        speeds.append(abs(optimum.best.speed))
    slope = (speeds[1] - speeds[0]) / (1 / RADIUS / (1 + 1e-5) - 1 / RADIUS / (1 - 1e-5))
    assert np.mean(prices) == pytest.approx(slope, rel=2e-3)


def test_the_gait_is_no_other_than_it_was_known():
    known = SineGait(1.72795636, 2.43105015, 0.16618580)
    best = maximize_speed(asked(RADIUS)).best
    assert best.gait.offset == pytest.approx(known.offset, rel=1e-3)
    assert best.share == pytest.approx(0.0, abs=1e-6)


STICKY = Problem(
    Robot(
        Platform(0.3156, 0.001622, 0.1091, 0.05153, 0.05879, 0.08064902956955979),
        Platform(0.6485, 0.004055, 0.1317, 0.007802, 0.06254, 0.10771503111596697),
        0.025,
    ),
    Limits(0.8694, 3.794, 5.0, 0.03),
    GaitBounds(Interval(0.2, 0.8), Interval(0.6885, 1.693), Interval(-0.9445, 0.9445)),
    RatioChoice(Interval(15.6, 15.6)),
    "either",
)


def test_the_tightest_circle_where_a_faster_gait_is_hardly_wider():
    """Twice the speed is had 1e-4 beside the circle: a climb may not rest there."""
    radius = 0.196679
    optimum = maximize_speed(replace(STICKY, turn=Turn(curvature=Interval(*[1 / radius] * 2))))
    assert optimum.best is not None, optimum.message
    cycle = steady_cycle(optimum.robot, optimum.best.gait).cycle
    assert cycle.radius == pytest.approx(radius, rel=1e-6)
    assert abs(cycle.speed) == pytest.approx(4.4817e-5, rel=1e-3)
