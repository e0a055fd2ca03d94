"""Figs. 4 and 5 again: average speed over amplitude, and over J20/J10 or the period."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.problem import Interval, Limits, Problem, RatioChoice
from rr_opt.model.robot import Robot
from rr_opt.verify.speeds import speeds
from rr_paper.printed import FIGURE_4, FIGURE_5, TABLE_1, Surface

RATE_LIMIT = TABLE_1["greatest rate dphi/dt"].value * 2 * math.pi / 60
"""Table 1's 30 rpm, rad/s."""
ANGLE_LIMIT = TABLE_1["greatest angle phi"].value
RPM = 30 / math.pi
"""rpm in one rad/s."""

_AMPLITUDE_STEP, _RATIO_STEP, _PERIOD_STEP = 0.01, 0.001, 0.01


@dataclass(frozen=True)
class SpeedSurface:
    """A surface of the paper.

    amplitude  (A,), rad
    ratio, period  J20/J10 and T (s), (X,) each; one of them is the same everywhere
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
        """Share of the surface's area that is beyond Table 1's 30 rpm."""
        top, least = self.amplitude[[-1, 0]]
        kept = RATE_LIMIT * self.period / (2 * math.pi) - least
        share = 1 - np.clip(kept / (top - least), 0.0, 1.0)
        return float(np.trapezoid(share) / (len(share) - 1))

    @property
    def best_amplitude(self) -> Array:
        """Amplitude of the largest |speed| in the way that small amplitudes drive, (X,)."""
        small = np.sign(self.speed[len(self.amplitude) // 8])
        return self.amplitude[(small * self.speed).argmax(axis=0)]

    @property
    def reverses_at(self) -> Array:
        """The least amplitude beyond which it drives the other way, (X,); NaN if none does."""
        small = np.sign(self.speed[len(self.amplitude) // 8])
        other = small * self.speed < 0
        other[: len(self.amplitude) // 8] = False
        first = self.amplitude[other.argmax(axis=0)]
        return np.where(other.any(axis=0), first, np.nan)


def figure4(robot: Robot) -> SpeedSurface:
    """Over J20/J10 (about P) at T = 1 s."""
    return _surface(robot, FIGURE_4, _steps(FIGURE_4.ratio, _RATIO_STEP), None)


def figure5(robot: Robot) -> SpeedSurface:
    """Over the period at J20/J10 = 0.3."""
    return _surface(robot, FIGURE_5, None, _steps(FIGURE_5.period, _PERIOD_STEP))


def posed(robot: Robot) -> Problem:
    """The robot with its inertia ratio open, about P, and no limit but the singular posture."""
    limits = Limits(math.inf, math.inf, math.inf)
    return Problem(robot, limits, inertia_ratio=RatioChoice(Interval(0.0, 1.0)))


def _surface(
    robot: Robot, spans: Surface, ratio: Array | None, period: Array | None
) -> SpeedSurface:
    across = ratio if ratio is not None else period
    if across is None:
        raise ValueError("a surface spans ratios or periods")
    J = np.full(len(across), spans.ratio[0]) if ratio is None else ratio
    T = np.full(len(across), spans.period[0]) if period is None else period
    alpha = _steps(spans.amplitude, _AMPLITUDE_STEP)
    found = speeds(posed(robot), alpha[:, None], T, 0.0, J[None, :])
    # At amplitude 0 nothing moves, and there is no cycle to resolve.
    speed = np.where(alpha[:, None] == 0, 0.0, found.speed)
    return SpeedSurface(alpha, J, T, speed)


def _steps(ends: tuple[float, float], step: float) -> Array:
    return np.linspace(*ends, round((ends[1] - ends[0]) / step) + 1)
