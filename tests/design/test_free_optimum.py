"""A climb by another method on another model does not go on from a free gait."""

import pytest

from benchmarks.free.climb import climb
from benchmarks.free.problems import BEATEN
from rr_opt.design.maximize_speed import maximize_speed


@pytest.mark.parametrize("name", BEATEN)
def test_no_climb_goes_on(name: str) -> None:
    problem = BEATEN[name]
    best = maximize_speed(problem).best
    assert best is not None
    end = climb(problem, best.gait, None)  # type: ignore[arg-type]
    assert end.excess <= 3e-5
    assert end.speed <= abs(best.speed) * (1 + 1e-4)
