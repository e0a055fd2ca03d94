"""The price of a turn is the speed gained when the curvature is asked a little larger."""

import pytest

from benchmarks.turn.problems import SHORT, turning
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import Interval, Turn

STEP = 1e-3


def test_price():
    problem, curvature = SHORT, -2.0

    def best(value):
        return maximize_speed(turning(problem, Turn(curvature=Interval(value, value)))).best

    size = STEP * abs(curvature)
    slope = (abs(best(curvature + size).speed) - abs(best(curvature - size).speed)) / (2 * size)
    assert best(curvature).prices["curvature"] == pytest.approx(slope, rel=1e-3)
