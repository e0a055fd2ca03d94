"""Candidates are ranked by feasibility, then success, then speed."""

from rr_opt.design.candidate import StartResult
from rr_opt.model.gait import SineGait


def candidate(feasible, success, speed):
    return StartResult(
        sign=1,
        gait=SineGait(1.0, 1.0),
        share=0.0,
        speed=speed,
        feasible=feasible,
        success=success,
        sentence="",
        iterations=0,
        prices={},
        bound_prices={},
        violation=0.0,
        intervals=16,
    )


def test_order():
    good = [candidate(True, True, 0.2), candidate(True, True, -0.1)]
    bad = [candidate(True, False, 0.5), candidate(False, True, 0.9), candidate(False, False, 2.0)]
    assert sorted([*bad, *good], key=lambda one: one.rank) == [*good, *bad]
