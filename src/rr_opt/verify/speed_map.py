"""Speed over amplitude and period, limits or not: what the figure of a sweep shows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rr_opt.problem import Problem
from rr_opt.robot.parameters import Robot
from rr_opt.verify.grid import boxes
from rr_opt.verify.speeds import least_S1, model_of, speeds

Array = NDArray[np.float64]

_SIDE, _TOLERANCE = {True: 120, False: 40}, {True: 1e-3, False: 3e-2}
"""Gaits along each side, and tolerance of their speeds, relative. Other friction than viscous
(False) takes some hundred times as long; contours drawn through fewer points look the same."""


class SpeedMap(NamedTuple):
    """Speed over amplitude and period: amplitudes (nA,), rad, periods (nT,), s, signed speed
    (nT, nA), m/s, peak torque (nT, nA), N m, and least S1 over the cycle (nA,), m. NaN past the
    singular posture."""

    amplitudes: Array
    periods: Array
    speed: Array
    peak_torque: Array
    least_S1: Array


def speed_map(problem: Problem, robot: Robot, offset: float) -> SpeedMap:
    """Speed of a grid of gaits over the problem's bounds of amplitude and period, on a robot
    with its ratio, whether or not they keep the limits: for a figure."""
    inside, viscous = boxes(problem), model_of(robot).viscous
    n = _SIDE[viscous]
    amplitude, period = inside["amplitude"], inside["period"]
    alpha = np.linspace(amplitude.low, amplitude.high, n)
    T = np.linspace(period.low, period.high, n)
    bare = Problem(robot, problem.limits, problem.gait)
    found = speeds(bare, alpha[:, None], T, offset, tolerance=_TOLERANCE[viscous])
    return SpeedMap(alpha, T, found.speed.T, found.peak_torque.T, least_S1(robot, alpha, offset))
