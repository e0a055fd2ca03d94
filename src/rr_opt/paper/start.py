"""Fig. 3 again: a start from rest, its path, and the average speed over a sliding period."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.motion.rollout import Trajectory, rollout
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.motion.transient import transient
from rr_opt.paper.printed import Row
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_RATE, _SECONDS = 100.0, 20.0


@dataclass(frozen=True)
class Start:
    """A run from rest.

    driven    at the capture system's 100 Hz
    t, speed  the average speed over the period about t: the displacement of P over T (s, m/s)
    steady    that of the steady cycle, signed, m/s
    constant  time in which what is missing falls to 1/e, s
    """

    row: Row
    gait: SineGait
    driven: Trajectory
    t: Array
    speed: Array
    steady: float
    constant: float


def start_from_rest(robot: Robot, row: Row) -> Start:
    """The run of a row of Table 3 from rest; Fig. 3 does not say which gait it shows."""
    if row.amplitude is None:
        raise ValueError("the row has no amplitude")
    gait = SineGait(row.amplitude, row.period)
    driven = rollout(robot, gait, _SECONDS, "rest", _RATE)
    every = round(row.period * _RATE)
    step = np.hypot(driven.x[every:] - driven.x[:-every], driven.y[every:] - driven.y[:-every])
    t = (driven.t[every:] + driven.t[:-every]) / 2
    cycle = steady_cycle(robot, gait)
    constant = transient(robot, cycle).constant
    return Start(row, gait, driven, t, step / row.period, cycle.speed, constant)


def last_period(t: Array, x: Array, y: Array, psi: Array, period: float) -> float:
    """Mean speed over the last period of a straight run, m/s, signed along platform 1.

    t (s), x, y (m), psi (rad): (n,), at equal steps of which a period holds a whole number.
    """
    steps = round(period / float(t[1] - t[0]))
    chord = np.array([x[-1] - x[-1 - steps], y[-1] - y[-1 - steps]])
    heading = psi[-steps:]
    ahead = chord @ np.array([np.cos(heading).mean(), np.sin(heading).mean()])
    return float(np.copysign(np.hypot(*chord), ahead)) / period
