"""The recomputed figures agree with what other methods compute."""

import math

import numpy as np
import pytest
from scipy.optimize import least_squares

from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from rr_paper.reproduction import last_period_speed


@pytest.mark.parametrize("name", ["ratio_surface", "period_surface"])
def test_points_of_the_surfaces(found, name):
    surface = getattr(found, name)
    for i, j in ((30, 20), (60, 100), (110, 60)):
        robot = with_inertia_ratio(found.robot, float(surface.ratio[j]))
        gait = SineGait(float(surface.amplitude[i]), float(surface.period[j]))
        expected = steady_cycle(robot, gait).speed
        assert surface.speed[i, j] == pytest.approx(expected, rel=1e-5)


def test_the_share_beyond_30_rpm(found):
    # alpha <= T/2: a rectangle of Fig. 4 and a trapezium of Fig. 5.
    assert found.ratio_surface.too_fast == pytest.approx(1 - 0.5 / 1.4, rel=1e-9)
    assert found.period_surface.too_fast == pytest.approx(1 - 0.7 / 1.2, rel=1e-9)


def test_a_start_comes_to_the_steady_speed(found):
    start = found.start
    assert start.speed[0] < 0.5 * abs(start.steady)
    assert start.speed[-1] == pytest.approx(abs(start.steady), rel=1e-5)
    d = start.driven
    last = last_period_speed(d.t, d.x, d.y, d.psi, start.gait.period)
    assert last == pytest.approx(start.steady, rel=1e-5)


def test_the_last_period_of_a_straight_run_backward():
    t = np.arange(0, 8.0, 0.1)
    swing = 0.3 * np.sin(np.pi * t)
    found = last_period_speed(t, -0.2 * t, 0.05 * np.cos(np.pi * t), swing, 2.0)
    assert found == pytest.approx(-0.2, rel=1e-9)


@pytest.mark.parametrize("which", [0, 1, 2])
def test_the_circles_are_round(found, which):
    """A circle through P at the same phase of each period has the centre of the mean circle."""
    one = found.turning.circles[which]
    at = slice(10 * 50, None, 50)
    x, y = one.driven.x[at], one.driven.y[at]
    fitted = least_squares(
        lambda c: np.hypot(x - c[0], y - c[1]) - c[2], [x.mean(), y.mean(), one.circle.radius]
    )
    assert np.abs(fitted.fun).max() < 1e-4 * one.circle.radius
    # P swings to both sides of the mean circle by less than a robot's length.
    assert fitted.x[2] == pytest.approx(one.circle.radius, abs=0.06)
    step = 2 * math.asin(np.hypot(x[1] - x[0], y[1] - y[0]) / 2 / fitted.x[2])
    assert step == pytest.approx(abs(one.circle.heading), rel=1e-3)
