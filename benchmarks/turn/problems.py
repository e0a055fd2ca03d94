"""Turns of every kind: radii from 0.2 to 5 m, either way and hand, whole cycles, every limit."""

from __future__ import annotations

import math
from dataclasses import replace

from benchmarks.optimise.problems import CENTRE, PAPER, WIDE, gait, limits, prototype, ratio, robot
from rr_opt.model.problem import Interval, Problem, Turn

OPEN = Interval(-2.6, 2.6)


def round_(radius: float) -> Turn:
    """A circle of this radius, m, positive to the left."""
    return Turn(curvature=Interval(1 / radius, 1 / radius))


def whole(heading: float, periods: int, radius: float) -> Turn:
    """An arc of this heading (rad) and radius (m) in a number of periods."""
    each = heading / periods
    return replace(round_(math.copysign(radius, heading)), heading=Interval(each, each))


PROTOTYPE = Problem(prototype(), limits(), gait(WIDE, OPEN), ratio(0.12, 0.3))
REFERENCE = Problem(robot(), limits(), gait(WIDE, OPEN), CENTRE)
NEVER = Problem(robot(c=0.3), limits(), gait(WIDE, OPEN), ratio(1.3, 3.0))
SHORT = Problem(robot(c=0.15, a=0.02), limits(), gait(WIDE, OPEN))


def turning(problem: Problem, turn: Turn, **changes) -> Problem:
    return replace(problem, turn=turn, **changes)


PROBLEMS: dict[str, Problem] = {
    "prototype_5m": turning(PROTOTYPE, round_(5.0)),
    "prototype_1m_forward": turning(PROTOTYPE, round_(1.0), direction="forward"),
    "prototype_30cm_right": turning(PROTOTYPE, round_(-0.3)),
    "prototype_40cm_backward": turning(PROTOTYPE, round_(0.4), direction="backward"),
    "paper_1m": turning(PROTOTYPE, round_(1.0), gait=gait(PAPER, OPEN)),
    "paper_2m_loads": turning(
        PROTOTYPE, round_(2.0), gait=gait(PAPER, OPEN), inertia_ratio=ratio(0.12, 0.3, by="loads")
    ),
    "reference_25cm": turning(REFERENCE, round_(0.25)),
    "reference_1m_torque": turning(REFERENCE, round_(-1.0), limits=limits(torque=0.05)),
    "reference_30cm_torque": turning(REFERENCE, round_(0.3), limits=limits(torque=0.03)),
    "no_rate_limit_50cm": turning(
        replace(REFERENCE, limits=limits(0.2, math.inf)), round_(0.5), direction="forward"
    ),
    "never_singular_1m": turning(NEVER, round_(1.0)),
    "never_singular_50cm_torque": turning(NEVER, round_(0.5), limits=limits(torque=0.1)),
    "short_2m": turning(SHORT, round_(2.0)),
    "short_30cm": turning(SHORT, round_(0.3)),
    "low_friction_30cm": turning(replace(REFERENCE, robot=robot(0.01)), round_(0.3)),
    "high_friction_1m": turning(replace(REFERENCE, robot=robot(0.5)), round_(1.0)),
    "positive_offsets_1m": turning(
        REFERENCE, round_(-1.0), gait=gait(WIDE, Interval(0.0, 1.0)), inertia_ratio=None
    ),
    "reference_yaw_rate": turning(REFERENCE, Turn(yaw_rate=Interval(2.0, math.inf))),
    "prototype_yaw_rate": turning(PROTOTYPE, Turn(yaw_rate=Interval(-math.inf, -0.5))),
    "reference_length": turning(REFERENCE, Turn(curvature=Interval(3.0, math.inf))),
    "prototype_whole": turning(PROTOTYPE, whole(math.pi / 2, 12, 0.5)),
    "reference_whole_torque": turning(
        REFERENCE, whole(-math.pi, 8, 0.5), limits=limits(torque=0.08)
    ),
}
