"""Solve on a mesh that is good enough: as fine as the gait needs, nodes where the torque peaks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.mesh import LADDER, Dense, dense, mesh_for, with_nodes_at
from rr_opt.design.setting import Setting, robot_of
from rr_opt.design.solve import Candidate, solve
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import NotConvergedError
from rr_opt.robot.gait import SineGait

Array = NDArray[np.float64]

_TRIAL = 36
"""Intervals on which a gait's own error is tried, to choose its mesh."""
_CLAIM = 3e-7
"""Largest error of a claimed speed, relative."""
_PEAK = 1e-6
"""Largest excess of the torque between nodes, relative."""
_REFINEMENTS = 8


def solve_from(setting: Setting, sign: int, gait: SineGait, share: float) -> Candidate:
    """Solve from a gait on a mesh that is fine enough for its cycle."""
    robot = robot_of(setting, share)
    seen = dense(setting.landscape, robot, gait, share)
    try:
        coarse = steady_cycle(robot, gait, steps=_TRIAL).speed
        error = abs(coarse - seen.speed) / abs(seen.speed)
        intervals = mesh_for(_TRIAL, error, _CLAIM / 2)
    except NotConvergedError:  # dry friction too steep for so coarse a mesh
        intervals = LADDER[-1]
    return solve(setting, sign, gait, share, _phases(setting, intervals, seen))


def _phases(setting: Setting, intervals: int, seen: Dense) -> Array:
    """Equal phases, with nodes moved onto the torque's peaks where its limit is near."""
    near = seen.peak > 0.97 * setting.problem.limits.torque
    return with_nodes_at(intervals, seen.peaks if near else np.array([]))


def refine(setting: Setting, candidate: Candidate) -> Candidate:
    """Solve again until the mesh claims the true speed and no torque peaks between nodes."""
    limit = setting.problem.limits.torque
    iterations = candidate.iterations
    for _ in range(_REFINEMENTS):
        gait, share = candidate.gait, candidate.share
        seen = dense(setting.landscape, robot_of(setting, share), gait, share)
        error = abs(abs(candidate.speed) - abs(seen.speed)) / abs(seen.speed)
        if error <= _CLAIM and seen.peak <= limit * (1 + _PEAK):
            break
        if error > _CLAIM and len(candidate.phases) == LADDER[-1]:
            break  # no finer mesh is left; the replay will say what the claim is worth
        intervals = len(candidate.phases)
        if error > _CLAIM:
            intervals = mesh_for(intervals, error, _CLAIM / 4)
        candidate = solve(setting, candidate.sign, gait, share, _phases(setting, intervals, seen))
        iterations += candidate.iterations
        if not (candidate.feasible and candidate.success):
            break
    return replace(candidate, iterations=iterations)
