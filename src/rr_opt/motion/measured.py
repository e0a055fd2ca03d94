"""What a driven motion amounts to: its largest torque, and its speed over the last period.

The samples of a trajectory may lie far apart, and hold one side of each jump of the torque. So the
motion is simulated once more, a period at a time, at times that meet every jump.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.motion.cycle import cycle_of
from rr_opt.motion.integrator import cvodes, whole_steps
from rr_opt.motion.rollout import Trajectory
from rr_opt.motion.torque import torque_after, torque_before
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_STEPS = 2048
_SNAP = 1e-9
"""So much of a period, at the end of a motion, is rounding."""
_SETTLED = 1e-9
"""A period that changes v by no more of its largest value repeats until the end."""


@dataclass(frozen=True)
class Measured:
    """Of a motion from its first to its last sample:

    peak_torque  largest |torque| of the servo at any time, N m
    mean_v       mean of v over the last period, m/s; over all of a motion that is shorter
    speed        along the mean circle of the last period, m/s, positive along platform 1; None of
                 a motion that is shorter
    """

    peak_torque: float
    mean_v: float
    speed: float | None


def measured(robot: Robot, gait: Gait, driven: Trajectory) -> Measured:
    """Measure a motion that a gait drives from phase 0.

    The last period ends with the last 2048th of one that the motion completes.
    """
    count = whole_steps(gait, _STEPS)
    grid = np.linspace(0.0, gait.period, count + 1)
    whole = math.floor(driven.t[-1] / gait.period + _SNAP)
    rest = float(driven.t[-1]) - whole * gait.period
    v, peak, path = float(driven.v[0]), 0.0, None
    for _ in range(whole):
        path = cvodes(robot, gait, v, grid)
        peak = max(peak, _peak(robot, gait, grid, path[0]))
        change, v = path[0, -1] - v, float(path[0, -1])
        if abs(change) <= _SETTLED * np.abs(path[0]).max():
            break
    least = _SNAP * gait.period
    if rest > least:
        begun = grid[grid <= rest + least]
        steps = len(begun)
        begun = begun if rest - begun[-1] <= least else np.append(begun, rest)
        end = cvodes(robot, gait, v, begun)
        peak = max(peak, _peak(robot, gait, begun, end[0]))
        if path is None:
            return Measured(peak, float(np.trapezoid(end[0], begun)) / rest, None)
        path = _last_period(path, end[:, :steps])
    if path is None:
        raise ValueError("a motion that takes no time has no measures")
    v, psi, x, y, _ = path
    speed = cycle_of(gait.period, x, y, psi).speed
    return Measured(peak, float(np.trapezoid(v)) / count, speed)


def _peak(robot: Robot, gait: Gait, t: Array, v: Array) -> float:
    """Largest |torque| at times t, N m: on both sides, but within the motion."""
    after = torque_after(robot, gait, t, v)
    before = torque_before(robot, gait, t, v) if gait.pieces > 1 else after
    return float(max(np.abs(after[:-1]).max(), np.abs(before[1:]).max()))


def _last_period(path: Array, begun: Array) -> Array:
    """The states (5, N + 1) of the last N steps, of a period and the one begun after it.

    Both begin with P at the origin and heading 0: the second is moved to the end of the first.
    """
    then = begun.copy()
    cos, sin = np.cos(path[1, -1]), np.sin(path[1, -1])
    then[1] += path[1, -1]
    then[2] = path[2, -1] + cos * begun[2] - sin * begun[3]
    then[3] = path[3, -1] + sin * begun[2] + cos * begun[3]
    return np.hstack([path[:, begun.shape[1] - 1 :], then[:, 1:]])
