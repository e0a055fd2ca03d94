"""Left and right are mirror images, and a turn ever wider ends at the straight gait."""

from dataclasses import replace

import pytest

from benchmarks.turn.problems import SHORT, round_, turning
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import Interval


def test_mirror():
    left, right = (maximize_speed(turning(SHORT, round_(r))).best for r in (0.7, -0.7))
    assert left.speed == pytest.approx(right.speed, rel=1e-7)
    assert left.gait.offset == pytest.approx(-right.gait.offset, rel=1e-4)


def test_straight_is_the_limit():
    gait = replace(SHORT.gait, offset=Interval(0.0, 0.0))
    straight = maximize_speed(replace(SHORT, gait=gait)).best.speed
    gaps = [
        abs(maximize_speed(turning(SHORT, round_(r))).best.speed / straight - 1)
        for r in (10.0, 1000.0)
    ]
    assert gaps[1] <= gaps[0] < 1e-2
    assert gaps[1] < 1e-6
