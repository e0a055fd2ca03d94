"""Tables 2 and 3 and Fig. 3 again, by the shipped prototype."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import transient
from rr_opt.motion.rollout import Trajectory, rollout
from rr_opt.motion.steady_cycle import steady_cycle
from rr_paper.consistency import ABOUT_P, predicted
from rr_paper.printed import TABLE_2, TABLE_3, Row

AMPLITUDES = np.linspace(0.2, 1.5, 261)
"""Where Table 2's amplitude is looked for, rad."""


@dataclass(frozen=True)
class Regenerated:
    """A printed row with the speed that the model gives it.

    amplitude  alpha, rad; of Table 2 the one that was found
    speed      signed, m/s
    """

    row: Row
    amplitude: float
    speed: float

    @property
    def near_mean(self) -> bool:
        """|speed| is within the printed interval."""
        return abs(abs(self.speed) - self.row.mean) <= self.row.half_width

    @property
    def near_other(self) -> bool:
        """|speed| is within an interval as wide about the other column."""
        return abs(abs(self.speed) - self.row.other) <= self.row.half_width

    @property
    def columns_agree(self) -> bool:
        """The column v_exp is within the printed interval, as the paper concludes."""
        return abs(self.row.other - self.row.mean) <= self.row.half_width


@dataclass(frozen=True)
class Tables:
    """Both tables, and what Table 2's amplitude may be.

    speeds   of Table 2's rows at AMPLITUDES, signed, m/s, (3, n)
    allowed  the amplitudes at which all three rows are within their intervals, as (low, high)
    """

    table2: tuple[Regenerated, ...]
    table3: tuple[Regenerated, ...]
    amplitude: float
    speeds: Array
    allowed: tuple[tuple[float, float], ...]


def regenerate(robot: Robot) -> Tables:
    """Both tables by this robot; J20/J10 about P.

    Table 2's amplitude is the one of AMPLITUDES at which the sum of squares of the misses, in
    half widths, is least: a fit, as the paper does not give it.
    """
    found = np.array([predicted(robot, ABOUT_P, float(one)) for one in AMPLITUDES]).T
    speeds = found[: len(TABLE_2)]
    mean = np.array([[row.mean] for row in TABLE_2])
    width = np.array([[row.half_width] for row in TABLE_2])
    off = (np.abs(speeds) - mean) / width
    best = int(np.nanargmin((off**2).sum(axis=0)))
    inside = np.asarray((np.abs(off) <= 1).all(axis=0))
    at = float(AMPLITUDES[best])
    return Tables(
        tuple(Regenerated(r, at, float(v)) for r, v in zip(TABLE_2, speeds[:, best], strict=True)),
        tuple(
            Regenerated(row, row.amplitude or at, float(v))
            for row, v in zip(TABLE_3, found[len(TABLE_2) :, best], strict=True)
        ),
        at,
        speeds,
        _runs(inside),
    )


def _runs(inside: NDArray[np.bool_]) -> tuple[tuple[float, float], ...]:
    """The ends of each run of amplitudes that are inside."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(int), [0]])))
    return tuple(
        (float(AMPLITUDES[start]), float(AMPLITUDES[end - 1]))
        for start, end in edges.reshape(-1, 2)
    )


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
