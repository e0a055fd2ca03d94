"""Of a robot whose two sides differ the sweep's model looks at whole periods and at both offsets.

Its speeds and turns are those of CVODES, also of gaits without offset, which then turn; and a range
of offsets is not cut in half.
"""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.motion.steady_cycle import reference_cycle
from rr_opt.verify.grid import boxes
from rr_opt.verify.speeds import speeds
from tests.robots import BENCHMARK

EFFECTS = {
    "left_right_drag": {"asymmetry1": 0.5, "asymmetry2": -0.3},
    "com_offset": {"d1": 0.01, "d2": -0.01},
    "axle_misalignment": {"toe1": 0.03, "toe2": -0.02},
}


def posed(robot: Robot) -> Problem:
    bounds = GaitBounds(
        amplitude=Interval(0.1, 1.0), period=Interval(0.5, 2.0), offset=Interval(-0.3, 0.3)
    )
    return Problem(robot=robot, gait=bounds, limits=Limits(angle=1.5, rate=10.0, torque=5.0))


@pytest.mark.parametrize("name", EFFECTS)
@pytest.mark.parametrize("offset", [0.0, 0.2, -0.2])
def test_speed_and_turn(name, offset):
    robot = replace(BENCHMARK, physics=(EffectUse(name, EFFECTS[name]),))
    found = speeds(posed(robot), 0.7, 1.0, offset)
    made = reference_cycle(robot, SineGait(0.7, 1.0, offset)).cycle
    assert found.converged
    assert float(found.speed) == pytest.approx(made.speed, rel=1e-5)
    assert float(found.turn) == pytest.approx(made.dpsi, rel=1e-5, abs=1e-8)
    assert abs(made.dpsi) > 1e-4


def test_both_offsets_are_looked_at():
    robot = replace(BENCHMARK, physics=(EffectUse("com_offset", EFFECTS["com_offset"]),))
    assert boxes(posed(robot))["offset"] == Interval(-0.3, 0.3)
    assert boxes(posed(BENCHMARK))["offset"] == Interval(0.0, 0.3)
    both = speeds(posed(robot), 0.7, 1.0, np.array([0.2, -0.2])).speed
    assert both[0] != pytest.approx(both[1], rel=1e-4)
