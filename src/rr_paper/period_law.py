"""Speed over the period: what viscous friction allows, and what the tables say.

At a fixed amplitude every term of equation (3) is slower by known powers of T: with viscous
friction alone the speed falls nearly as 1/T^2. The ratio v(T = 1 s)/v(T = 2 s) is then near 4
whatever the robot, and no unknown of the prototype can move it far.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_paper.consistency import ABOUT_P, BOX, prototype
from rr_paper.equation3 import CORRECTED, PRINTED, Signs, steady
from rr_paper.printed import TABLE_3, Row

_ROBOTS, _SEED = 500, 11


@dataclass(frozen=True)
class RatioOfPeriods:
    """v(1 s)/v(2 s) at one amplitude (rad).

    model          by the prototype with viscous friction
    mean, low, high  of the column with intervals, by Fieller's method with t of 2 degrees of
                   freedom, which errs on the wide side
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
    """The three ratios, and what robots of all kinds give."""

    ratios: tuple[RatioOfPeriods, ...]
    spreads: tuple[Spread, ...]


def audit_period(robot: Robot) -> PeriodLaw:
    """Hold the 1/T^2 law against Table 3."""
    fast = [row for row in TABLE_3 if row.period == 1.0]
    slow = [row for row in TABLE_3 if row.period == 2.0]
    built = ABOUT_P.build(robot, 0.3)
    ratios = tuple(_ratio(built, one, two) for one, two in zip(fast, slow, strict=True))
    return PeriodLaw(ratios, (_spread(CORRECTED), _spread(PRINTED)))


def fieller(one: tuple[float, float], two: tuple[float, float]) -> tuple[float, float]:
    """The interval of the ratio of two means, given with their half widths: all rho with
    |m1 - rho m2| within its own half width.

    Without an upper end where the denominator's own interval holds 0; ratios below 0 are left out
    then, as speeds of one robot have one sign.
    """
    (m1, h1), (m2, h2) = one, two
    a, b, c = m2**2 - h2**2, m1 * m2, m1**2 - h1**2
    root = math.sqrt(max(b**2 - a * c, 0.0))
    if a <= 0:
        return (b - root) / a if a < 0 < c else 0.0, math.inf
    return (b - root) / a, (b + root) / a


def _ratio(robot: Robot, fast: Row, slow: Row) -> RatioOfPeriods:
    alpha = fast.amplitude or math.nan
    low, high = fieller((fast.mean, fast.half_width), (slow.mean, slow.half_width))
    other = fieller((fast.other, fast.half_width), (slow.other, slow.half_width))
    model = _of_model(robot, alpha, CORRECTED)
    return RatioOfPeriods(
        alpha, model, fast.mean / slow.mean, low, high, fast.other / slow.other, *other
    )


def _of_model(robot: Robot, alpha: float, signs: Signs) -> float:
    fast, slow = (steady(robot, SineGait(alpha, T), signs).speed for T in (1.0, 2.0))
    return fast / slow


def _spread(signs: Signs) -> Spread:
    """Robots of the box, k spread evenly in its logarithm, at amplitudes of Table 3's range."""
    rng = np.random.default_rng(_SEED)
    amplitudes = [row.amplitude or math.nan for row in TABLE_3]
    found = []
    for _ in range(_ROBOTS):
        a1, a2, b = (rng.uniform(*BOX[name]) for name in ("a1", "a2", "b"))
        k = math.exp(rng.uniform(*np.log(BOX["k"])))
        alpha = rng.uniform(min(amplitudes), max(amplitudes))
        robot = ABOUT_P.build(prototype(a1, a2, b, k), 0.3)
        found.append(_of_model(robot, alpha, signs))
    q05, q50, q95 = np.quantile(found, [0.05, 0.5, 0.95]).tolist()
    return Spread(signs, _ROBOTS, q05, q50, q95, max(found))
