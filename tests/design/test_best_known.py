"""From default settings every benchmark problem ends at the best gait known, and keeps its limits.

The best known speeds come from a global search that shares no code with the package
(`benchmarks/optimise/brute_force.py`).
"""

import json
from pathlib import Path

import pytest

from benchmarks.optimise import problems
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.outcome import Status
from rr_opt.verify.replay import replay

KNOWN = json.loads(Path(problems.__file__).with_name("best_known.json").read_text())


@pytest.mark.parametrize("name", problems.PROBLEMS)
def test_best_known(name):
    problem = problems.PROBLEMS[name]
    optimum = maximize_speed(problem)
    assert optimum.status is Status.OPTIMAL
    best = optimum.best
    assert abs(best.speed) >= abs(KNOWN[name]["speed"]) * (1 - 1e-4)
    assert best.violation <= 1e-6
    seen = replay(optimum.robot, best.gait, problem.limits, best.speed)
    assert seen.error <= 1e-6
    assert seen.excess <= 1e-4
    if problem.direction != "either":
        assert (seen.speed > 0) == (problem.direction == "forward")
