"""Tables 2 and 3, Fig. 3, and the speed surfaces of Figs. 4 and 5, recomputed."""

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Interval, Limits, Problem, RatioChoice
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import transient
from rr_opt.motion.rollout import Trajectory, rollout
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.recordings.gaps import runs
from rr_opt.verify.speeds import speeds
from rr_paper.consistency import predicted
from rr_paper.prototype import ABOUT_P
from rr_paper.publication import FIGURE_4, FIGURE_5, RATE_LIMIT, TABLE_2, TABLE_3, Row, Surface

AMPLITUDES = np.linspace(0.2, 1.5, 261)
"""Candidates for Table 2's amplitude, rad."""

_RATE, _SECONDS = 100.0, 20.0
"""Fig. 3: the capture system's rate, Hz, and a time by which the transient has decayed, s."""


@dataclass(frozen=True)
class RecomputedRow:
    """A printed row with the model's speed, signed, m/s; amplitude in rad, of Table 2 fitted."""

    row: Row
    amplitude: float
    speed: float

    @property
    def within_mean(self) -> bool:
        """|speed| is within the printed interval."""
        return abs(abs(self.speed) - self.row.mean) <= self.row.half_width

    @property
    def within_other(self) -> bool:
        """|speed| is within an interval of the same width about the other column."""
        return abs(abs(self.speed) - self.row.other) <= self.row.half_width

    @property
    def columns_agree(self) -> bool:
        """The column v_exp is within the printed interval, as the paper concludes."""
        return abs(self.row.other - self.row.mean) <= self.row.half_width


@dataclass(frozen=True)
class Tables:
    """Both tables, and the possible amplitudes of Table 2.

    amplitude  the fitted one, rad
    speeds     of Table 2's rows at AMPLITUDES, signed, m/s, (3, n)
    allowed    ranges (low, high) of amplitude in which all three rows are within their intervals
    """

    table2: tuple[RecomputedRow, ...]
    table3: tuple[RecomputedRow, ...]
    amplitude: float
    speeds: Array
    allowed: tuple[tuple[float, float], ...]

    @property
    def rows(self) -> tuple[RecomputedRow, ...]:
        """All nine."""
        return *self.table2, *self.table3


def recompute(robot: Robot) -> Tables:
    """Both tables for this robot; J20/J10 about P.

    Table 2's amplitude is the one of AMPLITUDES with the least sum of squared residuals in half
    widths.
    """
    speeds = np.array([predicted(robot, ABOUT_P, one) for one in AMPLITUDES.tolist()]).T
    second, third = speeds[: len(TABLE_2)], speeds[len(TABLE_2) :]
    mean = np.array([[row.mean] for row in TABLE_2])
    width = np.array([[row.half_width] for row in TABLE_2])
    miss = (np.abs(second) - mean) / width
    best = int(np.nanargmin((miss**2).sum(axis=0)))
    at = float(AMPLITUDES[best])
    rows = [
        tuple(
            RecomputedRow(row, row.amplitude or at, float(speed))
            for row, speed in zip(table, of[:, best], strict=True)
        )
        for table, of in ((TABLE_2, second), (TABLE_3, third))
    ]
    allowed = runs(np.abs(miss).max(axis=0) <= 1)
    ends = tuple((float(AMPLITUDES[a]), float(AMPLITUDES[b - 1])) for a, b in allowed)
    return Tables(rows[0], rows[1], at, second, ends)


@dataclass(frozen=True)
class Start:
    """A run from rest.

    driven    at the capture system's 100 Hz
    t, speed  average speed over the period about t: the displacement of P over T (s, m/s)
    steady    that of the steady cycle, signed, m/s
    constant  time constant of the approach to the steady cycle, s
    """

    row: Row
    gait: SineGait
    driven: Trajectory
    t: Array
    speed: Array
    steady: float
    constant: float


def start_from_rest(robot: Robot, row: Row, gait: SineGait) -> Start:
    """The gait of a row of Table 3 from rest; Fig. 3 does not say which gait it shows."""
    driven = rollout(robot, gait, _SECONDS, "rest", _RATE)
    every = round(row.period * _RATE)
    step = np.hypot(driven.x[every:] - driven.x[:-every], driven.y[every:] - driven.y[:-every])
    t = (driven.t[every:] + driven.t[:-every]) / 2
    cycle = steady_cycle(robot, gait)
    constant = transient(robot, cycle).constant
    return Start(row, gait, driven, t, step / row.period, cycle.speed, constant)


_AMPLITUDE_STEP, _RATIO_STEP, _PERIOD_STEP = 0.01, 0.001, 0.01

NO_LIMITS = Limits(math.inf, math.inf, math.inf)
"""None but the singular posture."""


@dataclass(frozen=True)
class SpeedSurface:
    """A surface of the paper.

    amplitude  (A,), rad
    ratio, period  J20/J10 and T (s), (X,) each; one of them is constant
    speed      (A, X), signed, m/s
    """

    amplitude: Array
    ratio: Array
    period: Array
    speed: Array

    @property
    def rate(self) -> Array:
        """Peak rate of the servo, rad/s, (A, X)."""
        return 2 * math.pi * self.amplitude[:, None] / self.period

    @property
    def too_fast(self) -> float:
        """Share of the surface's area beyond Table 1's 30 rpm."""
        top, least = self.amplitude[[-1, 0]]
        kept = RATE_LIMIT * self.period / (2 * math.pi) - least
        share = 1 - np.clip(kept / (top - least), 0.0, 1.0)
        return float(np.trapezoid(share) / (len(share) - 1))


def figure4(robot: Robot) -> SpeedSurface:
    """Over J20/J10 (about P) at T = 1 s."""
    ratio = _steps(FIGURE_4.ratio, _RATIO_STEP)
    return _surface(robot, FIGURE_4, ratio, np.full(len(ratio), FIGURE_4.period[0]))


def figure5(robot: Robot) -> SpeedSurface:
    """Over the period at J20/J10 = 0.3."""
    period = _steps(FIGURE_5.period, _PERIOD_STEP)
    return _surface(robot, FIGURE_5, np.full(len(period), FIGURE_5.ratio[0]), period)


def _surface(robot: Robot, spans: Surface, ratio: Array, period: Array) -> SpeedSurface:
    amplitude = _steps(spans.amplitude, _AMPLITUDE_STEP)
    problem = Problem(robot, NO_LIMITS, inertia_ratio=RatioChoice(Interval(0.0, 1.0)))
    seen = speeds(problem, amplitude[:, None], period, 0.0, ratio[None, :])
    # At amplitude 0 nothing moves, and there is no cycle to resolve.
    return SpeedSurface(
        amplitude, ratio, period, np.where(amplitude[:, None] == 0, 0.0, seen.speed)
    )


def _steps(ends: tuple[float, float], step: float) -> Array:
    return np.linspace(*ends, round((ends[1] - ends[0]) / step) + 1)
