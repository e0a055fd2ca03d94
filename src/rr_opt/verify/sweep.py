"""The sweep: a dense grid over all decisions, which every optimum must match or beat.

It shares robot, problem and derived physics with the optimiser and nothing else: the steady
cycle is found by Fourier series, the best point by exhaustive search.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_opt.verify.climb import KEPT, Aim, Climbed, climb, cost_of_transport, peak_torque, turn_rows
from rr_opt.verify.evaluate import Evaluated, Found, Progress, evaluate
from rr_opt.verify.grid import DECISIONS, Grid, boxes, free_decisions, grid_of, mirrored
from rr_opt.verify.speeds import model_of, robot_with, speed_of, speeds

_SIDE, _TOLERANCE = {True: 120, False: 40}, {True: 1e-3, False: 3e-2}
"""Gaits along each side, and relative tolerance of their speeds. Friction that is not viscous
(False) takes some hundred times as long; contours through fewer points look the same."""


class SpeedMap(NamedTuple):
    """Speed over period and amplitude, at one offset and inertia ratio.

    period (T,) s; amplitude (A,) rad; speed (A, T) m/s signed; torque (A, T) N m, the peak. Past
    the singular posture both are NaN.
    """

    period: Array
    amplitude: Array
    speed: Array
    torque: Array


def speed_map(problem: Problem, robot: Robot, offset: float) -> SpeedMap:
    """Speed of a grid of gaits over the problem's bounds of amplitude and period, on a robot with
    its ratio, feasible or not: for a figure."""
    inside, viscous = boxes(problem), model_of(robot).viscous
    n = _SIDE[viscous]
    amplitude, period = inside["amplitude"], inside["period"]
    alpha = np.linspace(amplitude.low, amplitude.high, n)
    T = np.linspace(period.low, period.high, n)
    bare = Problem(robot, problem.limits, problem.gait)
    found = speeds(bare, alpha[:, None], T, offset, tolerance=_TOLERANCE[viscous])
    return SpeedMap(T, alpha, found.speed, found.peak_torque)


TOLERATED = 1e-4
"""Largest relative difference of a claimed speed from the sweep's own for that gait."""


class _Effort(NamedTuple):
    """points of a grid in all; relative tolerance of its speeds, and of the best one's; number of
    climbs from its best points, and where hardly any is feasible; and the relative gain over a
    claim that is tolerated."""

    points: int
    tolerance: float
    fine: float
    climbs: int
    more: int
    gained: float


# Friction that is not viscous takes some hundred times as long.
_EFFORT = {
    True: _Effort(10_000, 1e-4, 1e-8, 4, 12, 1e-6),
    False: _Effort(600, 0.03, 5e-5, 2, 2, 1e-4),
}
_FINALISTS, _ALIKE = 3, 1e-3
"""Most climbs that run to convergence, from gaits that differ by more than this in one decision's
range."""
_OFF, _MOST_OFF = 2.0, 5.0
"""Relative loss of speed for an excess of 1 at a start, and the largest excess that counts."""


@dataclass(frozen=True)
class SweepResult:
    """The result of a sweep.

    grid     the values of each decision
    found    all points evaluated, those on the lines where limits are active among them
    best     the best feasible point among them, None if there is none
    refined  the best optimum of the climbs from the best few points
    points   how many points were evaluated in all
    """

    grid: Grid
    found: Evaluated
    best: Found | None
    refined: Found | None
    points: int


@dataclass(frozen=True)
class SweepCheck:
    """A claimed optimum, compared with a sweep.

    points         evaluated, near the claimed optimum and over the whole box
    best           feasible; offset >= 0 where gaits at phi0 and -phi0 are equivalent;
                   None if none was found
    gap            (claimed - best)/claimed, of speeds or of distances per energy: negative where
                   the sweep found something better
    gained         relative gain of a further climb from the claimed gait; NaN for another shape
    tolerated      largest allowed value of either
    speed          of the claimed gait, by the sweep's model, signed, m/s
    error          |speed - claimed|/|claimed|; NaN where the model cannot follow the gait's shape
    largest_error  largest allowed error; both tolerances grow where the mean speed is a small
                   difference of forward and backward motion
    cost           of transport of the claimed gait, by the sweep's model; NaN if not the objective
    """

    points: int
    best: Found | None
    gap: float
    gained: float
    tolerated: float
    speed: float
    error: float
    largest_error: float = TOLERATED
    cost: float = math.nan

    @property
    def better(self) -> Found | None:
        """The gait that refutes the claim, if any."""
        return None if self.gap >= -self.tolerated else self.best

    @property
    def passed(self) -> bool:
        """Nothing better was found, and the claimed speed is confirmed."""
        return self.better is None and not self.error > self.largest_error


def sweep(
    problem: Problem,
    counts: Mapping[str, int] | int | None = None,
    progress: Progress | None = None,
) -> SweepResult:
    """Evaluate a grid over the problem's own bounds and climb from its best points.

    counts: values of each free decision by name (amplitude, period, offset, ratio), or one
    number for all of them, or None for some 10 000 points in all.
    """
    effort = _EFFORT[model_of(problem.robot).viscous]
    grid = grid_of(problem, _counts(problem, counts, effort.points))
    found = evaluate(problem, grid, effort.tolerance, progress)
    feasible = found.feasible.any()
    most = effort.climbs if feasible and not problem.turn else effort.more
    starts = tops(found, _merit(problem, found), grid, most)
    end, more = climbed(problem, found.decisions[:, starts])
    return SweepResult(
        grid=grid,
        found=found,
        best=found.found(int(found.merit.argmax())) if feasible else None,
        refined=end,
        points=found.speed.size + more,
    )


def climbed(problem: Problem, starts: Array, aim: Aim = "speed") -> tuple[Found | None, int]:
    """The best result of climbs from gaits (4, K), None if none of the best is feasible; and how
    many gaits were evaluated. All climb a little, and the best of them to convergence."""
    rough = [climb(problem, start, aim, rough=True) for start in starts.T]
    fine = [climb(problem, end, aim) for end in _finalists(problem, rough)]
    ends = sorted((end for end in fine if end.kept), key=lambda end: -end.value)
    found = next((one for end in ends if (one := _resolved(problem, end.decisions))), None)
    return found, sum(end.points for end in (*rough, *fine))


def _finalists(problem: Problem, ends: Sequence[Climbed]) -> list[Array]:
    """The best few distinct gaits, (4,) each, that climbs led to."""
    spans = np.array([boxes(problem)[name].high - boxes(problem)[name].low for name in DECISIONS])
    chosen: list[Array] = []
    for end in sorted(ends, key=lambda end: -end.value):
        apart = [np.abs(end.decisions - one) > _ALIKE * spans for one in chosen]
        if len(chosen) < _FINALISTS and all(part.any() for part in apart):
            chosen.append(end.decisions)
    return chosen


def _resolved(problem: Problem, decisions: Array) -> Found | None:
    """A gait (4,) with its speed; None where that is not resolved or a peak was missed."""
    viscous = model_of(problem.robot).viscous
    amplitude, period, offset, ratio = decisions.tolist()
    known = None if math.isnan(ratio) else ratio
    seen = speeds(problem, amplitude, period, offset, known, _EFFORT[viscous].fine)
    torque, slack = float(seen.peak_torque), TOLERATED
    if viscous:
        torque, slack = peak_torque(problem, decisions), 10 * KEPT
    if not seen.converged or torque > problem.limits.torque * (1 + slack):
        return None
    gait, speed, turn = SineGait(amplitude, period, offset), float(seen.speed), float(seen.turn)
    cost = cost_of_transport(problem, decisions) if problem.economy else math.nan
    return Found(gait, known, speed, torque, turn, problem.merit(speed, cost))


def check_optimum(
    problem: Problem,
    gait: Gait,
    ratio: float | None,
    speed: float,
    everywhere: SweepResult | None = None,
    cost: float = math.nan,
) -> SweepCheck:
    """Compare a claimed optimum with a sweep of the whole problem and a further climb from it.

    A gait of another shape is compared with all sines, which an optimum of its family must match or
    beat.

    gait, ratio (J20/J10 in the problem's definition; read only if the problem has one) and
    signed speed (m/s) as claimed, and cost of transport where it is the objective; everywhere: the
    result of `sweep`, if available.
    """
    effort = _EFFORT[model_of(problem.robot).viscous]
    if problem.inertia_ratio is None:
        ratio = None
    everywhere = everywhere or sweep(problem)
    finalists, points = [everywhere.refined], everywhere.points
    gained, own_cost = math.nan, math.nan
    here, scale = speed_of(robot_with(problem, ratio), gait)
    allowance = max(1.0, scale / abs(speed))
    if isinstance(gait, SineGait):
        own = speeds(problem, gait.amplitude, gait.period, gait.offset, ratio, effort.fine)
        here = float(own.speed)
        offset = abs(gait.offset) if mirrored(problem) else gait.offset
        claimed = (gait.amplitude, gait.period, offset, math.nan if ratio is None else ratio)
        end, more = climbed(problem, np.array(claimed)[:, None])
        finalists, points = [*finalists, end], points + more
        if problem.economy:
            own_cost = cost_of_transport(problem, np.array(claimed))
        gained = end.merit / problem.merit(here, own_cost) - 1 if end else 0.0
    there = [one for one in finalists if one is not None]
    best = max(there, key=lambda one: one.merit, default=None)
    return SweepCheck(
        points=points,
        best=best,
        gap=1 - best.merit / problem.merit(speed, cost) if best else math.inf,
        gained=gained,
        tolerated=effort.gained * allowance,
        speed=here,
        error=abs(here - speed) / abs(speed),
        largest_error=TOLERATED * allowance,
        cost=own_cost,
    )


def _counts(
    problem: Problem, counts: Mapping[str, int] | int | None, points: int
) -> Mapping[str, int]:
    free = free_decisions(problem)
    if counts is None:
        counts = max(4, math.ceil(points ** (1 / max(len(free), 1))))
    return dict.fromkeys(free, counts) if isinstance(counts, int) else counts


def tops(found: Evaluated, merit: Array, grid: Grid, most: int) -> list[int]:
    """Indices of the points with the most merit that are at least two grid spacings from better
    ones, best first."""
    spacing = {name: float(np.diff(grid.axis(name)).max()) for name in grid.free}
    apart = np.array([2.0 * spacing.get(name, math.inf) for name in DECISIONS])[:, None]
    chosen: list[int] = []
    while merit.size and len(chosen) < most and merit.max() > -np.inf:
        top = int(merit.argmax())
        chosen.append(top)
        away = np.abs(found.decisions - found.decisions[:, [top]]) / apart
        merit = np.where(np.nanmax(away, axis=0) > 1, merit, -np.inf)
    return chosen


def _merit(problem: Problem, found: Evaluated) -> Array:
    """The speed, less a penalty for each violated row where few points are feasible: for a turn, or
    tight limits."""
    if found.feasible.any() and not problem.turn:
        return found.merit
    speed = np.abs(found.speed)
    less, equal = turn_rows(problem, speed, found.turn, found.decisions[1])
    off = sum([np.maximum(-row, 0.0) for row in less] + [np.abs(row) for row in equal])
    off = off + np.maximum(found.peak_torque / problem.limits.torque - 1, 0.0)
    off = off + ~found.keeps["direction"] + ~found.keeps["economy"]
    merit = found.value * (1 - _OFF * np.clip(off, 0.0, _MOST_OFF))
    return np.where(np.isfinite(merit) & found.keeps["rate"], merit, -np.inf)
