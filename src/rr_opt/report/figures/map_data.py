"""The grid behind the speed map, from the sweep's model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.problem import GaitBounds, Interval, Problem
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot
from rr_opt.verify.sweep import speed_map

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MapData:
    """What the map shows, at one offset and inertia ratio.

    period (T,) s; amplitude (A,) rad; speed (A, T) m/s signed; torque (A, T) N m, the peak.
    Where the robot would pass its singular posture both are nan.
    """

    period: Array
    amplitude: Array
    speed: Array
    torque: Array


def map_data(problem: Problem, robot: Robot, best: SineGait) -> MapData:
    """Speed and peak torque around the optimum, over the problem's bounds.

    A quantity that the problem fixes is shown from half to one and a half times its value.
    """
    shown = replace(
        problem,
        gait=GaitBounds(
            _opened(problem.gait.amplitude), _opened(problem.gait.period), problem.gait.offset
        ),
    )
    found = speed_map(shown, robot, best.offset)
    return MapData(found.periods, found.amplitudes, found.speed.T, found.peak_torque.T)


def _opened(box: Interval) -> Interval:
    return Interval(0.5 * box.low, 1.5 * box.high) if box.fixed else box
