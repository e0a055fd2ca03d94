"""All gaits of a problem, without a solver: the sweep, and the chart of its circles."""

from __future__ import annotations

import math

from rr_opt.api.load import PathLike, identity, problem_of
from rr_opt.model.problem import Problem
from rr_opt.motion.dynamics import require_friction
from rr_opt.results.result import Progress, quiet
from rr_opt.results.sweep import Sweep
from rr_opt.results.turn_chart import TurnChart
from rr_opt.verify import sweep as verify
from rr_opt.verify.grid import free_decisions
from rr_opt.verify.turn_chart import radius_claim, sign_claim, tightest, turn_map


def sweep(
    problem: Problem | PathLike, points: int = 10_000, *, progress: Progress = quiet
) -> Sweep:
    """Evaluate about `points` gaits all over the bounds, and refine the best.

    Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    counts = max(2, math.ceil(points ** (1 / max(len(free_decisions(problem)), 1))))
    tried = verify.sweep(problem, counts, lambda done, of: progress(f"gait {done} of {of}"))
    return Sweep(*identity(problem), problem, tried)


_DRAWN = (6, 4, 121)
"""Amplitudes, periods and offsets of the chart."""
_TESTED = (24, 10, 101)
"""The same of the map on which the paper's claim is tested."""


def turn_chart(problem: Problem | PathLike, *, progress: Progress = quiet) -> TurnChart:
    """Radius over offset, amplitude and period, and the tightest circle within the limits.

    The inertia ratio is that of the robot as it is. Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    progress("chart")
    seen = turn_map(problem, _DRAWN)
    progress("the paper's claim")
    fine = turn_map(problem, _TESTED)
    progress("tightest circle")
    tight = tightest(problem)
    claims = sign_claim(fine), radius_claim(fine)
    return TurnChart(*identity(problem), problem, seen, tight, *claims)
