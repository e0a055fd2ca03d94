"""Every benchmark turn ends at the best gait known, from default settings, and turns as asked.

The best known gaits come from a search that shares no code with the package
(`benchmarks/turn/brute_force.py`).
"""

import json
from pathlib import Path

import pytest

from benchmarks.turn import problems
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.outcome import Status
from rr_opt.verify.replay import replay

KNOWN = json.loads(Path(problems.__file__).with_name("best_known.json").read_text())


# The others are no harder; `python -m benchmarks.turn` holds them all.
NAMES = [
    "prototype_5m", "prototype_1m_forward", "prototype_40cm_backward", "paper_2m_loads",
    "reference_25cm", "no_rate_limit_50cm", "never_singular_50cm_torque", "short_30cm",
    "prototype_yaw_rate", "reference_whole_torque",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_best_known(name):
    problem = problems.PROBLEMS[name]
    optimum = maximize_speed(problem)
    assert optimum.status is Status.OPTIMAL
    best = optimum.best
    assert abs(best.speed) >= abs(KNOWN[name]["speed"]) * (1 - 1e-4)
    seen = replay(optimum.robot, best.gait, problem.limits, best.speed)
    assert seen.excess <= 1e-4
    cycle = seen.steady.cycle
    did = {
        "heading": cycle.dpsi,
        "yaw_rate": cycle.dpsi / cycle.period,
        "curvature": cycle.dpsi / cycle.period / abs(cycle.speed),
    }
    for quantity, value in did.items():
        asked = getattr(problem.turn, quantity)
        assert value == pytest.approx(asked.clip(value), rel=1e-6)
