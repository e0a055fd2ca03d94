"""The turn that a problem asks for, as rows that a search can penalise.

The curvature grows without bound where the speed passes through zero, and its sign jumps there.
The angle atan(curvature * length) does not: it is the direction of the pair (speed, yaw rate *
length), whose plane the gaits fill smoothly. `length` is the radius that is asked for, so that
the angle changes fastest where it matters; but at most some lengths of the robot, or it would be
a step where left turns into right.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.problem import ANY, Interval, Turn
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_LENGTHS = 5.0


@dataclass(frozen=True)
class TurnRows:
    """Rows of a Turn: those of its quantities that are asked for, scaled."""

    turn: Turn
    length: float

    @property
    def intervals(self) -> tuple[Interval, ...]:
        """The interval of each row."""
        rows = []
        if self.turn.curvature != ANY:
            ends = (self.turn.curvature.low, self.turn.curvature.high)
            rows.append(Interval(*(math.atan(end * self.length) for end in ends)))
        for asked in (self.turn.yaw_rate, self.turn.heading):
            if asked != ANY:
                rows.append(Interval(asked.low / _size(asked), asked.high / _size(asked)))
        return tuple(rows)

    def values(self, speed: Array, turn: Array, period: Array) -> list[Array]:
        """The rows of gaits with this speed (m/s), heading per period (rad) and period (s)."""
        rows = []
        if self.turn.curvature != ANY:
            rows.append(np.arctan2(turn / period * self.length, np.abs(speed)))
        if self.turn.yaw_rate != ANY:
            rows.append(turn / period / _size(self.turn.yaw_rate))
        if self.turn.heading != ANY:
            rows.append(turn / _size(self.turn.heading))
        return rows


def turn_rows(turn: Turn, robot: Robot) -> TurnRows:
    """The rows of a turn that this robot is to make."""
    longest = _LENGTHS * (robot.platform1.c + robot.platform2.c)
    asked = turn.curvature != ANY and 1 / _size(turn.curvature)
    return TurnRows(turn, min(asked or longest, longest))


def _size(asked: Interval) -> float:
    """The size of what is asked; 1 if that is nothing but straight."""
    ends = [abs(end) for end in (asked.low, asked.high) if math.isfinite(end)]
    return max(ends) or 1.0
