"""Figs. 4 and 5 recomputed: average speed over amplitude, and over J20/J10 or the period."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.problem import Interval, Limits, Problem, RatioChoice
from rr_opt.model.robot import Robot
from rr_opt.verify.speeds import speeds
from rr_paper.publication import FIGURE_4, FIGURE_5, RATE_LIMIT, Surface

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
