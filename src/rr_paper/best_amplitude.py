"""What remains of the paper's conclusion that there is a best amplitude, of about 1 rad."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.api.optimise import maximize_speed
from rr_opt.model.problem import GaitBounds, Interval, Problem
from rr_opt.model.robot import Robot
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_paper.consistency import Hypothesis
from rr_paper.prototype import ABOUT_P, prototype, random_prototype
from rr_paper.publication import ANGLE_LIMIT, FIGURE_4, FIGURE_5, RATE_LIMIT
from rr_paper.signs import CORRECTED, Signs, steady_cycle
from rr_paper.tables import NO_LIMITS

_STEP, _NEAREST = 0.02, 0.97
"""Step of the amplitude, rad, and how near it comes to the singular angle."""
_PEAK_ROBOTS, _PEAK_SEED = 150, 3


@dataclass(frozen=True)
class Peak:
    """Speed over amplitude at T = 1 s, up to Fig. 4's 1.4 rad or the singular posture.

    amplitude  of the largest |speed| in the direction in which small amplitudes drive, rad
    inside     it is a maximum, and not the end of the range
    reverses   the least amplitude that drives the other way, rad; None if none does
    """

    amplitude: float
    inside: bool
    reverses: float | None


@dataclass(frozen=True)
class PeakStatistics:
    """Of random robots of the box at one J20/J10: how many have a maximum inside, and how many
    drive the other way beyond some amplitude; quantiles 5, 50 and 95 % of the maxima inside."""

    ratio: float
    robots: int
    inside: int
    reversing: int
    quantiles: tuple[float, float, float]


@dataclass(frozen=True)
class BestAmplitude:
    """What remains of the paper's conclusion.

    own      the prototype's peak by J20/J10
    fitted   those of the robots fitted to the tables, by name
    robots   those of random robots
    limited, unlimited  the checked optima within Fig. 5's range, with Table 1's limits and without
    allowed  amplitude that 30 rpm leaves at T = 1 s, rad
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
    """Look for the best amplitude of this robot, of fitted and of random ones."""
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
