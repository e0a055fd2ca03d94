"""Statements of the paper, audited: its gaits and the servo, circles and offset, the period, the
best amplitude."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.api.optimise import maximize_speed
from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import Circle, circle_of
from rr_opt.motion.rollout import Trajectory, rollout
from rr_opt.motion.steady_cycle import steady_cycle as simulated_cycle
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_opt.verify.speeds import speeds
from rr_opt.verify.turn_chart import RadiusClaim, SignClaim, radius_claim, sign_claim, turn_map
from rr_paper.consistency import Hypothesis
from rr_paper.prototype import ABOUT_P, box_grid, prototype, random_prototype
from rr_paper.publication import (
    ANGLE_LIMIT,
    FIGURE_4,
    FIGURE_5,
    FIGURE_6,
    RATE_LIMIT,
    RPM,
    TABLE_3,
    Row,
)
from rr_paper.signs import CORRECTED, PRINTED, Signs, steady_cycle
from rr_paper.tables import NO_LIMITS


@dataclass(frozen=True)
class ServoDemand:
    """A gait of the paper: amplitude in rad, period in s."""

    where: str
    amplitude: float
    period: float

    @property
    def of_table3(self) -> bool:
        """Whether it is a run of Table 3."""
        return self.where.startswith("Table 3")

    @property
    def rpm(self) -> float:
        """The peak rate 2 pi alpha/T, rpm."""
        return 2 * math.pi * self.amplitude / self.period * RPM

    @property
    def excess(self) -> float | None:
        """How far it exceeds Table 1's 30 rpm, rpm; None if it does not."""
        return self.rpm - RATE_LIMIT * RPM if self.rpm > RATE_LIMIT * RPM else None


@dataclass(frozen=True)
class SingularPosture:
    """The angle at which S1 = c1 cos phi + c2 vanishes, rad: of the robot as assumed, and the least
    and largest over the box of a1 and a2."""

    angle: float
    least: float
    largest: float


def servo_demands(table2_amplitude: float) -> tuple[ServoDemand, ...]:
    """For every gait that the paper drove, and the fastest corner of each surface."""
    return (
        *(
            ServoDemand(f"Table 3, row {i}", row.amplitude or math.nan, row.period)
            for i, row in enumerate(TABLE_3, 1)
        ),
        ServoDemand("Table 2, with the fitted amplitude", table2_amplitude, 1.0),
        ServoDemand("Fig. 4, largest amplitude", FIGURE_4.amplitude[1], FIGURE_4.period[0]),
        ServoDemand(
            "Fig. 5, largest at the shortest period", FIGURE_5.amplitude[1], FIGURE_5.period[0]
        ),
        ServoDemand("Fig. 6", FIGURE_6.amplitude, FIGURE_6.period),
    )


def singular_posture(robot: Robot) -> SingularPosture:
    """The singular posture of a robot and of the box."""
    angles = [one.singular_angle for one in box_grid(25)]
    return SingularPosture(robot.singular_angle, min(angles), max(angles))


_NEAREST = 0.97
"""Largest angle of the map, relative to the singular one."""
_RATE = 50.0
_MAP = (24, 10, 101)
"""Amplitudes, periods and offsets of the map, as in `rr-opt turn-chart`."""
_OFFSETS = 400


@dataclass(frozen=True)
class GaitCircle:
    """A gait of Fig. 6: its steady circle, that of the mirrored gait, and one lap from rest."""

    gait: SineGait
    circle: Circle
    mirrored: Circle
    driven: Trajectory


@dataclass(frozen=True)
class Turning:
    """Fig. 6 and its claims.

    circles     the three of the figure
    offset, curvature  along phi0 > 0 at the figure's amplitude and period, up to the singular
                posture: rad, 1/m (positive to the left)
    sign, radius  the claims over all feasible gaits of the shipped problem
    """

    circles: tuple[GaitCircle, ...]
    offset: Array
    curvature: Array
    sign: SignClaim
    radius: RadiusClaim

    @property
    def sides_hold(self) -> bool:
        """The three turn to one side, and the mirrored gaits to the other."""
        first = np.sign(self.circles[0].circle.heading)
        return all(
            np.sign(one.circle.heading) == first and np.sign(one.mirrored.heading) == -first
            for one in self.circles
        )

    @property
    def radii_hold(self) -> bool:
        """Of the three, a larger offset has a smaller radius."""
        radii = [one.circle.radius for one in self.circles]
        return radii == sorted(radii, reverse=True)

    @property
    def changes_side_at(self) -> float | None:
        """The offset at which the turn first changes sides, rad; None if it never does."""
        changed = np.flatnonzero(np.sign(self.curvature[1:]) != np.sign(self.curvature[0]))
        return float(self.offset[changed[0] + 1]) if len(changed) else None

    @property
    def tightest_at(self) -> float:
        """The offset at which the radius stops falling, rad; the last one if it never does."""
        size = np.abs(self.curvature)
        falls = np.flatnonzero(size[1:] < size[:-1])
        return float(self.offset[falls[0]] if len(falls) else self.offset[-1])


def audit_turning(problem: Problem) -> Turning:
    """Drive the circles of Fig. 6 and test the claims on the shipped problem's gaits."""
    robot = ABOUT_P.build(problem.robot, FIGURE_6.ratio)
    alpha, T = FIGURE_6.amplitude, FIGURE_6.period
    circles = tuple(_circle(robot, SineGait(alpha, T, phi0)) for phi0 in FIGURE_6.offsets)
    end = _NEAREST * robot.singular_angle - alpha
    offset = np.linspace(0.0, end, _OFFSETS + 1)[1:]
    seen = speeds(Problem(robot, problem.limits), alpha, T, offset)
    there = seen.converged
    curvature = seen.turn[there] / (T * np.abs(seen.speed[there]))
    chart = turn_map(problem, _MAP)
    return Turning(circles, offset[there], curvature, sign_claim(chart), radius_claim(chart))


def _circle(robot: Robot, gait: SineGait) -> GaitCircle:
    other = SineGait(gait.amplitude, gait.period, -gait.offset)
    circle, mirrored = (circle_of(simulated_cycle(robot, one).cycle) for one in (gait, other))
    seconds = circle.time_round + 5 * gait.period
    return GaitCircle(gait, circle, mirrored, rollout(robot, gait, seconds, "rest", _RATE))


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

    It has no upper end if the denominator's own interval contains 0; negative ratios are then
    excluded, as the speeds of one robot have one sign.
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


_STEP = 0.02
"""Step of the amplitude, rad."""
_PEAK_ROBOTS, _PEAK_SEED = 150, 3


@dataclass(frozen=True)
class Peak:
    """Speed over amplitude at T = 1 s, up to Fig. 4's 1.4 rad or the singular posture.

    amplitude  of the largest |speed| in the direction in which small amplitudes drive, rad
    inside     it is an interior maximum, not the end of the range
    reverses   the least amplitude that drives the other way, rad; None if none does
    """

    amplitude: float
    inside: bool
    reverses: float | None


@dataclass(frozen=True)
class PeakStatistics:
    """For random robots of the box at one J20/J10: how many have an interior maximum, and how many
    drive the other way beyond some amplitude; quantiles 5, 50 and 95 % of the interior maxima."""

    ratio: float
    robots: int
    inside: int
    reversing: int
    quantiles: tuple[float, float, float]


@dataclass(frozen=True)
class BestAmplitude:
    """The audit of the paper's conclusion.

    own      the prototype's peak by J20/J10
    fitted   those of the robots fitted to the tables, by name
    robots   those of random robots
    limited, unlimited  the checked optima within Fig. 5's range, with Table 1's limits and without
    allowed  largest amplitude within 30 rpm at T = 1 s, rad
    """

    own: tuple[tuple[float, Peak], ...]
    fitted: tuple[tuple[str, Peak], ...]
    robots: tuple[PeakStatistics, ...]
    limited: FastestGait
    unlimited: FastestGait
    allowed: float = RATE_LIMIT / (2 * math.pi)

    @property
    def confirmed(self) -> bool:
        """Whether simulation and sweep agree with the optimiser on both optima."""
        return all(one.status is Status.OPTIMAL for one in (self.limited, self.unlimited))


def audit_best_amplitude(
    robot: Robot, fits: Sequence[Hypothesis], progress: Callable[[str], None]
) -> BestAmplitude:
    """Find the best amplitude of this robot, of fitted and of random ones."""
    ratios = (*FIGURE_4.ratio, FIGURE_5.ratio[0])
    own = tuple((ratio, peak_of(ABOUT_P.build(robot, ratio), CORRECTED)) for ratio in ratios)
    fitted = []
    for one in fits:
        unknowns = {key: value for key, value in one.fit.values.items() if key != "amplitude"}
        built = one.definition.build(prototype(**unknowns), FIGURE_5.ratio[0])
        fitted.append((one.name, peak_of(built, one.signs)))
    progress("best amplitude of random robots")
    robots = tuple(_peak_statistics(ratio) for ratio in ratios[1:])
    progress("fastest gaits of Fig. 5")
    loaded = ABOUT_P.build(robot, FIGURE_5.ratio[0])
    limits = replace(NO_LIMITS, angle=ANGLE_LIMIT, rate=RATE_LIMIT)
    box = GaitBounds(Interval(0.05, FIGURE_5.amplitude[1]), Interval(*FIGURE_5.period))
    limited, unlimited = (
        maximize_speed(Problem(loaded, these, box)) for these in (limits, NO_LIMITS)
    )
    return BestAmplitude(own, tuple(fitted), robots, limited, unlimited)


def peak_of(robot: Robot, signs: Signs) -> Peak:
    """The best amplitude of a robot at T = 1 s."""
    end = min(FIGURE_4.amplitude[1], _NEAREST * robot.singular_angle)
    alpha = np.arange(_STEP, end, _STEP)
    speed = steady_cycle(robot, alpha, 1.0, signs).speed
    ahead = np.sign(speed[len(alpha) // 8]) * speed
    best = int(ahead.argmax())
    back = np.flatnonzero(ahead[best:] < 0)
    return Peak(
        float(alpha[best]),
        best < len(alpha) - 1,
        float(alpha[best + back[0]]) if len(back) else None,
    )


def _peak_statistics(ratio: float) -> PeakStatistics:
    rng = np.random.default_rng(_PEAK_SEED)
    robots = [ABOUT_P.build(random_prototype(rng), ratio) for _ in range(_PEAK_ROBOTS)]
    peaks = [peak_of(robot, CORRECTED) for robot in robots]
    inside = [one.amplitude for one in peaks if one.inside]
    q05, q50, q95 = np.quantile(inside, [0.05, 0.5, 0.95]).tolist() if inside else [math.nan] * 3
    reversing = sum(one.reverses is not None for one in peaks)
    return PeakStatistics(ratio, _PEAK_ROBOTS, len(inside), reversing, (q05, q50, q95))
