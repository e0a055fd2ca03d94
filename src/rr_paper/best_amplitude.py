"""The paper's best amplitude, by itself and within limits; and what its runs ask of the servo."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.design.maximize_speed import Optimum, maximize_speed
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.model.robot import Robot
from rr_opt.verify.replay import Replay, replay
from rr_opt.verify.sweep import SweepCheck, check_optimum
from rr_paper.consistency import ABOUT_P, BOX, Fit, Reading, prototype
from rr_paper.equation3 import CORRECTED, Signs, steady
from rr_paper.printed import FIGURE_4, FIGURE_5, FIGURE_6, TABLE_3
from rr_paper.surfaces import ANGLE_LIMIT, RATE_LIMIT, RPM


@dataclass(frozen=True)
class Fastest:
    """The optimum within Fig. 5's range, checked by a simulation and by a sweep."""

    limited: bool
    optimum: Optimum
    replayed: Replay | None
    check: SweepCheck | None

    @property
    def confirmed(self) -> bool:
        """The simulation and the sweep agree with it."""
        return (
            self.replayed is not None
            and self.check is not None
            and self.replayed.error <= 1e-6
            and self.check.passed
        )


def fastest(robot: Robot, limited: bool) -> Fastest:
    """The optimum for a robot as it is; limited: within Table 1's angle and rate."""
    free = Limits(math.inf, math.inf, math.inf)
    table = replace(free, angle=ANGLE_LIMIT, rate=RATE_LIMIT)
    amplitude = Interval(0.05, FIGURE_5.amplitude[1])
    box = GaitBounds(amplitude, Interval(*FIGURE_5.period))
    problem = Problem(robot, table if limited else free, box)
    optimum = maximize_speed(problem)
    best = optimum.best
    if best is None or optimum.robot is None:
        return Fastest(limited, optimum, None, None)
    seen = replay(optimum.robot, best.gait, problem.limits, best.speed)
    check = check_optimum(problem, best.gait, optimum.ratio, best.speed)
    return Fastest(limited, optimum, seen, check)


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
    robot: Robot, fits: Sequence[tuple[str, Reading, Signs, Fit]], progress: Callable[[str], None]
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


@dataclass(frozen=True)
class Asked:
    """A gait of the paper, and its peak rate in rad/s."""

    where: str
    amplitude: float
    period: float

    @property
    def rate(self) -> float:
        """2 pi alpha/T, rad/s."""
        return 2 * math.pi * self.amplitude / self.period

    @property
    def rpm(self) -> float:
        """The peak rate in rpm."""
        return self.rate * RPM

    @property
    def too_fast(self) -> bool:
        """Beyond Table 1's 30 rpm."""
        return self.rate > RATE_LIMIT


@dataclass(frozen=True)
class Posture:
    """The singular posture S1 = c1 cos phi + c2 = 0: the angle for the robot as assumed, and the
    least and largest over the box of a1 and a2, rad; the servo's own range."""

    angle: float
    least: float
    largest: float
    servo: float = ANGLE_LIMIT


def asked(table2_amplitude: float) -> tuple[Asked, ...]:
    """Every gait that the paper drove, and the fastest corner of each surface."""
    return (
        *(
            Asked(f"Table 3, row {i}", row.amplitude or math.nan, row.period)
            for i, row in enumerate(TABLE_3, 1)
        ),
        Asked("Table 2, with the amplitude found", table2_amplitude, 1.0),
        Asked("Fig. 4, largest amplitude", FIGURE_4.amplitude[1], FIGURE_4.period[0]),
        Asked("Fig. 5, largest at the shortest period", FIGURE_5.amplitude[1], FIGURE_5.period[0]),
        Asked("Fig. 6", FIGURE_6.amplitude, FIGURE_6.period),
    )


def posture(robot: Robot) -> Posture:
    """Where the singular posture is."""
    corners = [
        prototype(float(a1), float(a2), 0.03, 0.1).singular_angle
        for a1 in np.linspace(*BOX["a1"], 25)
        for a2 in np.linspace(*BOX["a2"], 25)
    ]
    return Posture(robot.singular_angle, min(corners), max(corners))
