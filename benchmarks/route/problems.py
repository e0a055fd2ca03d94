"""The routes, and the robots that drive them."""

from __future__ import annotations

import math
from dataclasses import replace

import rr_opt as rr
from benchmarks.turn.problems import REFERENCE, SHORT
from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.problem import Interval, Problem
from rr_opt.model.route import Arc, Piece, Pose, Straight, Waypoint

QUARTER = math.pi / 2


def plain(problem: Problem) -> Problem:
    """With the robot as it is, and no offset asked for."""
    gait = replace(problem.gait, offset=Interval(0.0, 0.0))
    return replace(problem, inertia_ratio=None, gait=gait)


LOADED = with_inertia_ratio(rr.prototype(), 0.3)
ROBOTS: dict[str, Problem] = {
    "prototype, J20/J10 = 0.3": plain(rr.shipped()).with_robot(LOADED),
    "reference": plain(REFERENCE),
    "short": plain(SHORT),
}

SIDE = (Straight(0.6), Arc(0.4, QUARTER))
ROUTES: dict[str, tuple[Piece, ...]] = {
    "straight 1 m": (Straight(1),),
    "straight 3 m": (Straight(3),),
    "straight 10 m": (Straight(10),),
    "U-turn": (Straight(0.5), Arc(0.5, math.pi), Straight(0.5)),
    "S-bend": (Arc(0.8, QUARTER), Arc(0.8, -QUARTER)),
    "square": (*SIDE, *SIDE, *SIDE, *SIDE),
    "slalom": (Arc(1, 0.7), Arc(1, -1.4), Arc(1, 1.4), Arc(1, -0.7)),
    "parking": (Straight(0.5), Waypoint(1.6, 0.8, QUARTER)),
    "figure of eight": (Arc(0.6, 4 * QUARTER), Arc(0.6, -4 * QUARTER)),
    "tight circle": (Arc(0.4, 4 * QUARTER),),
    "infeasible": (Straight(0.5), Arc(0.1, QUARTER)),
}
START = Pose()
