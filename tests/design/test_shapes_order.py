"""Each family of shapes contains the one before, and its optimum is no slower; all are confirmed
by a simulation and by the sweep's model, neither of which knows the optimiser."""

from __future__ import annotations

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.maximize_speed import Optimum, compare_shapes
from rr_opt.outcome import Status
from rr_opt.verify.replay import replay
from rr_opt.verify.speeds import speed_of


@pytest.fixture(scope="module", params=["paper_forward", "paper_torque"])
def optima(request: pytest.FixtureRequest) -> list[Optimum]:
    return compare_shapes(PROBLEMS[request.param])


def test_order(optima: list[Optimum]) -> None:
    assert [one.problem.gait.shape for one in optima] == ["sine", "fourier", "fourier", "free"]
    assert all(one.status is Status.OPTIMAL for one in optima)
    speeds = [abs(one.best.speed) for one in optima if one.best]
    assert speeds == sorted(speeds)


def test_confirmed(optima: list[Optimum]) -> None:
    for one in optima:
        best = one.best
        assert best is not None
        assert one.robot is not None
        seen = replay(one.robot, best.gait, one.problem.limits, best.speed)
        assert seen.error <= 1e-6
        assert seen.excess <= 1e-4
        assert speed_of(one.robot, best.gait)[0] == pytest.approx(best.speed, rel=1e-5)
        bounds = one.problem.gait
        assert bounds.period.low - 1e-6 <= best.gait.period <= bounds.period.high + 1e-6
        assert best.gait.offset == pytest.approx(0.0, abs=1e-7)
        assert best.gait.amplitude <= bounds.amplitude.high * (1 + 1e-4)
