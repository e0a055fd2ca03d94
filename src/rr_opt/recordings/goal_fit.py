"""When the servo was given its command, on the clock of its log: the goal against the gait."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.clocks import command_reference, likely_fits
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]

_IN_PERIOD = 16
"""Starts of the fit in a period of the command."""
_LOOKED_AT = 400
"""Samples that the starts are compared on."""
_MOST = 6


def goal_fits(log: ServoLog, gait: Gait, *, from_rest: bool) -> tuple[ClockFit, ...]:
    """The log's goal against the command: all likely fits, the command's time being t + offset.

    from_rest: the command's first angle is held before its time 0, which shows when it began if
    the log goes back so far. Otherwise whole periods stay open. Empty without a goal that moves.
    """
    goal = log.goal_angle
    if goal is None:
        return ()
    moving = np.flatnonzero(np.isfinite(goal))
    moving = moving[_commanded(goal[moving], from_rest=from_rest)]
    if len(moving) < 2:
        return ()
    t, goal = log.t[moving], goal[moving]
    reference = command_reference(gait, from_rest=from_rest)
    step = gait.period / _IN_PERIOD
    # A periodic command is the same a period later; one that begins is not.
    span = t[-1] - t[0] if from_rest else 0.0
    shifts = np.arange(-t[0] - span, -t[0] + gait.period, step)
    look = np.linspace(0, len(t) - 1, min(_LOOKED_AT, len(t))).astype(int)
    off = np.array([_off(goal[look], reference(t[look] + one)[0]) for one in shifts])
    lowest = [
        i for i in range(len(off))
        if off[i] <= off[max(i - 1, 0)] and off[i] <= off[min(i + 1, len(off) - 1)]
    ]  # fmt: skip
    lowest.sort(key=lambda i: off[i])
    return likely_fits(t, goal, reference, [float(shifts[i]) for i in lowest[:_MOST]])


def _commanded(goal: Array, *, from_rest: bool) -> NDArray[np.bool_]:
    """Without the time after the last change, and unless it tells the start, before the first."""
    changes = np.flatnonzero(np.diff(goal))
    row = np.arange(len(goal))
    if not len(changes):
        return np.zeros(len(goal), bool)
    return (row <= changes[-1] + 1) & ((row >= changes[0]) | from_rest)


def _off(goal: Array, told: Array) -> float:
    """Root mean square difference, but for a constant: phi's zero is not the clock's affair."""
    return float(np.std(goal - told))
