"""The fastest gaits within the range of Fig. 5, by the optimiser, with limits and without."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rr_opt.design.maximize_speed import Optimum, maximize_speed
from rr_opt.paper.printed import FIGURE_5
from rr_opt.paper.surfaces import ANGLE_LIMIT, RATE_LIMIT
from rr_opt.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.robot.parameters import Robot
from rr_opt.verify.replay import Replay, replay
from rr_opt.verify.sweep import SweepCheck, check_optimum


@dataclass(frozen=True)
class Fastest:
    """The optimum within Fig. 5's range, checked by a simulation and by a sweep."""

    limited: bool
    optimum: Optimum
    replayed: Replay | None
    check: SweepCheck | None

    @property
    def confirmed(self) -> bool:
        """The simulation and the sweep agree with it."""
        return (
            self.replayed is not None
            and self.check is not None
            and self.replayed.error <= 1e-6
            and self.check.passed
        )


def fastest(robot: Robot, limited: bool) -> Fastest:
    """The optimum for a robot as it is; limited: within Table 1's angle and rate."""
    free = Limits(math.inf, math.inf, math.inf)
    table = replace(free, angle=ANGLE_LIMIT, rate=RATE_LIMIT)
    amplitude = Interval(0.05, FIGURE_5.amplitude[1])
    box = GaitBounds(amplitude, Interval(*FIGURE_5.period))
    problem = Problem(robot, table if limited else free, box)
    optimum = maximize_speed(problem)
    best = optimum.best
    if best is None or optimum.robot is None:
        return Fastest(limited, optimum, None, None)
    seen = replay(optimum.robot, best.gait, problem.limits, best.speed)
    check = check_optimum(problem, best.gait, optimum.ratio, best.speed)
    return Fastest(limited, optimum, seen, check)
