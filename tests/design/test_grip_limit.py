"""Grip is a limit: no axle needs more, and its price is the speed that more of it would gain."""

import math
import re
from dataclasses import replace

import pytest

import rr_opt as rr
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.motion.steady_cycle import grip_needed, reference_cycle
from tests.robots import BENCHMARK

GAIT = GaitBounds(period=Interval(0.3, 3.0))


def posed(grip, rate=math.pi, **changes):
    return Problem(BENCHMARK, limits=Limits(grip=grip, rate=rate), gait=replace(GAIT, **changes))


@pytest.mark.parametrize("gait", [{}, {"shape": "fourier", "harmonics": 2}])
def test_it_is_kept_and_priced(gait):
    best = maximize_speed(posed(0.1, **gait)).best
    assert max(grip_needed(reference_cycle(BENCHMARK, best.gait), BENCHMARK)) == pytest.approx(
        0.1, rel=1e-4
    )
    more, less = (abs(maximize_speed(posed(0.1 + d, **gait)).best.speed) for d in (1e-3, -1e-3))
    assert best.prices["grip"] == pytest.approx((more - less) / 2e-3, rel=0.05)


def test_it_is_reported_and_warned_of():
    found = rr.maximize_speed(posed(math.inf, rate=12.0))
    row, record = found.limits["grip"], found.record()
    assert (row.limit, row.active) == (math.inf, False)
    assert row.value > 0.5
    assert max(record["grip"].values()) == pytest.approx(row.value)
    assert any("coefficient of friction" in text for text in found.warnings)
    held = rr.maximize_speed(posed(0.3, rate=12.0))
    assert held.limits["grip"].active
    assert held.status == "optimal", held.message
    assert not held.warnings
    assert re.search(r"limited by[^.]* grip of", " ".join(held.summary().split()))
    assert re.search(
        r"side force over load +0.3 +0.3 +active +\+[\d.]+ mm/s per 0.01", held.summary()
    )
    assert abs(held.speed) < abs(found.speed)
