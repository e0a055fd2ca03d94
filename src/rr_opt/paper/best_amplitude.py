"""The paper's best amplitude, "about 1 rad, for our prototype": by itself, and within limits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.equation3 import CORRECTED, Signs, steady
from rr_opt.paper.fastest import Fastest, fastest
from rr_opt.paper.fit import Fit
from rr_opt.paper.nine_rows import BOX, prototype
from rr_opt.paper.printed import FIGURE_4, FIGURE_5
from rr_opt.paper.readings import ABOUT_P, Reading
from rr_opt.paper.surfaces import RATE_LIMIT
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_STEP, _NEAREST = 0.02, 0.97
"""Amplitudes are tried in steps of so many rad, up to this share of the singular angle."""
_ROBOTS, _SEED = 150, 3


@dataclass(frozen=True)
class Peak:
    """Speed over amplitude at T = 1 s, up to Fig. 4's 1.4 rad or the singular posture.

    amplitude  of the largest |speed| in the way that small amplitudes drive, rad
    inside     it is a maximum, and not the end of the range
    reverses   the least amplitude that drives the other way, rad; None if none does
    """

    amplitude: float
    inside: bool
    reverses: float | None


@dataclass(frozen=True)
class OfFit:
    """The peak of a fitted robot at J20/J10 = 0.3."""

    name: str
    peak: Peak


@dataclass(frozen=True)
class OfRobots:
    """Random robots of the box at one J20/J10: how many have a maximum inside, and how many
    drive the other way beyond some amplitude; quantiles 5, 50 and 95 % of the maxima inside."""

    ratio: float
    robots: int
    inside: int
    reversing: int
    quantiles: tuple[float, float, float]


@dataclass(frozen=True)
class BestAmplitude:
    """What becomes of the conclusion.

    own      the prototype's peak by J20/J10
    fitted   those of the fits to the tables
    robots   those of random robots
    fastest  the optima within Fig. 5's range with Table 1's limits and without any
    allowed  amplitude that 30 rpm leaves at T = 1 s, rad
    """

    own: tuple[tuple[float, Peak], ...]
    fitted: tuple[OfFit, ...]
    robots: tuple[OfRobots, ...]
    fastest: tuple[Fastest, ...]
    allowed: float = RATE_LIMIT / (2 * math.pi)


def audit_best(
    robot: Robot,
    fits: Sequence[tuple[str, Reading, Signs, Fit]],
    progress: Callable[[str], None],
) -> BestAmplitude:
    """Look for the best amplitude; fits: by name, reading and signs of equation (3)."""
    ratios = (*FIGURE_4.ratio, FIGURE_5.ratio[0])
    own = tuple((J, peak_of(ABOUT_P.build(robot, J), CORRECTED)) for J in ratios)
    fitted = []
    for name, reading, signs, one in fits:
        known = {key: value for key, value in one.values.items() if key != "amplitude"}
        fitted.append(OfFit(name, peak_of(reading.build(prototype(**known), 0.3), signs)))
    progress("best amplitude of random robots")
    robots = tuple(_of_robots(J) for J in ratios[1:])
    progress("fastest gaits of Fig. 5")
    loaded = ABOUT_P.build(robot, FIGURE_5.ratio[0])
    optima = tuple(fastest(loaded, limited) for limited in (True, False))
    return BestAmplitude(own, tuple(fitted), robots, optima)


def peak_of(robot: Robot, signs: Signs) -> Peak:
    """The best amplitude of a robot at T = 1 s."""
    end = min(FIGURE_4.amplitude[1], _NEAREST * robot.singular_angle)
    alpha = np.arange(_STEP, end, _STEP)
    speed = np.array([steady(robot, SineGait(float(a), 1.0), signs).speed for a in alpha])
    ahead = np.sign(speed[len(alpha) // 8]) * speed
    best = int(ahead.argmax())
    back = np.flatnonzero(ahead[best:] < 0)
    return Peak(
        float(alpha[best]),
        best < len(alpha) - 1,
        float(alpha[best + back[0]]) if len(back) else None,
    )


def _of_robots(ratio: float) -> OfRobots:
    rng = np.random.default_rng(_SEED)
    peaks = []
    for _ in range(_ROBOTS):
        a1, a2, b = (rng.uniform(*BOX[name]) for name in ("a1", "a2", "b"))
        k = math.exp(rng.uniform(*np.log(BOX["k"])))
        peaks.append(peak_of(ABOUT_P.build(prototype(a1, a2, b, k), ratio), CORRECTED))
    inside = [one.amplitude for one in peaks if one.inside]
    q05, q50, q95 = np.quantile(inside, [0.05, 0.5, 0.95]).tolist() if inside else [math.nan] * 3
    reversing = sum(one.reverses is not None for one in peaks)
    return OfRobots(ratio, _ROBOTS, len(inside), reversing, (q05, q50, q95))
