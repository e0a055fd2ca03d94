"""A whole number of periods makes exactly the heading asked for, and no other number is faster."""

import math

import pytest

from benchmarks.turn.problems import PROTOTYPE, round_, turning, whole
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.design.turn import Target, fastest_turn
from rr_opt.motion.steady_cycle import steady_cycle


def test_whole():
    problem, heading = PROTOTYPE, -1.6
    turned = fastest_turn(problem, Target(heading=heading, radius=0.5, whole=True))
    count = round(turned.arc.periods)
    cycle = steady_cycle(turned.optimum.robot, turned.optimum.best.gait).cycle
    assert count * cycle.dpsi == pytest.approx(heading, rel=1e-6)
    assert cycle.radius == pytest.approx(0.5, rel=1e-6)
    speed = abs(turned.optimum.best.speed)
    free = maximize_speed(turning(problem, round_(math.copysign(0.5, heading))))
    assert speed <= abs(free.best.speed) * (1 + 1e-6)
    for other in {count - 1, count + 1} - {0}:
        rival = maximize_speed(turning(problem, whole(heading, other, 0.5))).best
        assert rival is None or abs(rival.speed) <= speed * (1 + 1e-6)
