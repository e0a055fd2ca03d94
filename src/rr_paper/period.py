"""The effect of the period, checked against Table 3.

At a fixed amplitude every term of equation (3) scales with a known power of T, so with viscous
friction alone the speed falls nearly as 1/T^2. The ratio v(T = 1 s)/v(T = 2 s) is then near 4 for
any robot, and no unknown of the prototype can move it far.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.model.robot import Robot
from rr_paper.equation3 import CORRECTED, PRINTED, Signs, steady_cycle
from rr_paper.prototype import ABOUT_P, random_prototype
from rr_paper.publication import TABLE_3, Row

_ROBOTS, _SEED = 500, 11
_RATIO = TABLE_3[0].ratio


@dataclass(frozen=True)
class PeriodRatio:
    """v(1 s)/v(2 s) at one amplitude (rad).

    model          of the prototype with viscous friction
    mean, low, high  of the column with intervals, by Fieller's method with t of 2 degrees of
                   freedom, which is conservative
    other, other_low, other_high  the same of the column v_exp, as if the intervals were its own
    """

    amplitude: float
    model: float
    mean: float
    low: float
    high: float
    other: float
    other_low: float
    other_high: float

    @property
    def model_inside(self) -> bool:
        """Whether the model's own ratio is within the interval of the mean column."""
        return self.low <= self.model <= self.high


@dataclass(frozen=True)
class Spread:
    """The ratio over random robots of the box: quantiles 5 %, 50 %, 95 %, and the largest."""

    signs: Signs
    robots: int
    q05: float
    q50: float
    q95: float
    largest: float


@dataclass(frozen=True)
class PeriodLaw:
    """Table 3's three ratios, and those of random robots with corrected and with printed signs."""

    ratios: tuple[PeriodRatio, ...]
    spreads: tuple[Spread, Spread]


def audit_period(robot: Robot) -> PeriodLaw:
    """Compare the 1/T^2 law with Table 3."""
    fast = [row for row in TABLE_3 if row.period == 1.0]
    slow = [row for row in TABLE_3 if row.period == 2.0]
    built = ABOUT_P.build(robot, _RATIO)
    ratios = tuple(_period_ratio(built, one, two) for one, two in zip(fast, slow, strict=True))
    return PeriodLaw(ratios, (_spread(CORRECTED), _spread(PRINTED)))


def fieller(one: tuple[float, float], two: tuple[float, float]) -> tuple[float, float]:
    """The interval of the ratio of two means, given with their half widths: all rho with
    |m1 - rho m2| within its own half width.

    Without an upper end if the denominator's own interval contains 0; ratios below 0 are excluded
    then, as the speeds of one robot have one sign.
    """
    (m1, h1), (m2, h2) = one, two
    a, b, c = m2**2 - h2**2, m1 * m2, m1**2 - h1**2
    root = math.sqrt(max(b**2 - a * c, 0.0))
    if a <= 0:
        return (b - root) / a if a < 0 < c else 0.0, math.inf
    return (b - root) / a, (b + root) / a


def _period_ratio(robot: Robot, fast: Row, slow: Row) -> PeriodRatio:
    alpha = fast.amplitude or math.nan
    mean = fieller((fast.mean, fast.half_width), (slow.mean, slow.half_width))
    other = fieller((fast.other, fast.half_width), (slow.other, slow.half_width))
    model = _model_ratio(robot, alpha, CORRECTED)
    return PeriodRatio(alpha, model, fast.mean / slow.mean, *mean, fast.other / slow.other, *other)


def _model_ratio(robot: Robot, alpha: float, signs: Signs) -> float:
    fast, slow = steady_cycle(robot, alpha, [1.0, 2.0], signs).speed.tolist()
    return fast / slow


def _spread(signs: Signs) -> Spread:
    """Robots of the box at amplitudes of Table 3's range."""
    rng = np.random.default_rng(_SEED)
    amplitudes = [row.amplitude or math.nan for row in TABLE_3]
    ratios = []
    for _ in range(_ROBOTS):
        robot = ABOUT_P.build(random_prototype(rng), _RATIO)
        ratios.append(_model_ratio(robot, rng.uniform(min(amplitudes), max(amplitudes)), signs))
    q05, q50, q95 = np.quantile(ratios, [0.05, 0.5, 0.95]).tolist()
    return Spread(signs, _ROBOTS, q05, q50, q95, max(ratios))
