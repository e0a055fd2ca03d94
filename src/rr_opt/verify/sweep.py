"""The sweep: a dense grid over all decisions, which no optimum may fall short of.

It shares robot, problem and derived physics with the optimiser and nothing else: the steady
cycle is found by Fourier series, the best point by looking everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_opt.verify.evaluate import Evaluated, Found, Progress, evaluate, zoom
from rr_opt.verify.grid import DECISIONS, Grid, boxes, free_decisions, grid_of, mirrored
from rr_opt.verify.speeds import least_S1, model_of, robot_with, speed_of, speeds

_SIDE, _TOLERANCE = {True: 120, False: 40}, {True: 1e-3, False: 3e-2}
"""Gaits along each side, and tolerance of their speeds, relative. Other friction than viscous
(False) takes some hundred times as long; contours drawn through fewer points look the same."""


class SpeedMap(NamedTuple):
    """Speed over amplitude and period: amplitudes (nA,), rad, periods (nT,), s, signed speed
    (nT, nA), m/s, peak torque (nT, nA), N m, and least S1 over the cycle (nA,), m. NaN past the
    singular posture."""

    amplitudes: Array
    periods: Array
    speed: Array
    peak_torque: Array
    least_S1: Array


def speed_map(problem: Problem, robot: Robot, offset: float) -> SpeedMap:
    """Speed of a grid of gaits over the problem's bounds of amplitude and period, on a robot
    with its ratio, whether or not they keep the limits: for a figure."""
    inside, viscous = boxes(problem), model_of(robot).viscous
    n = _SIDE[viscous]
    amplitude, period = inside["amplitude"], inside["period"]
    alpha = np.linspace(amplitude.low, amplitude.high, n)
    T = np.linspace(period.low, period.high, n)
    bare = Problem(robot, problem.limits, problem.gait)
    found = speeds(bare, alpha[:, None], T, offset, tolerance=_TOLERANCE[viscous])
    return SpeedMap(alpha, T, found.speed.T, found.peak_torque.T, least_S1(robot, alpha, offset))


TOLERATED = 1e-4
"""A sweep that beats an optimum by more than this, relative, refutes it."""

_FINAL = 1e-6
"""Tolerance of the speeds that are compared with a claim, relative."""


class _Effort(NamedTuple):
    """points of a grid in all; tolerance of its speeds, and of the best one's, relative; how many
    of its best points are climbed from, down to which share of the grid's spacing, and values
    per decision of the grid around a claimed optimum."""

    points: int
    tolerance: float
    fine: float
    climbs: int
    least: float
    around: int


_ROUGH = 0.1
"""Share of the grid's spacing to which all climbs go, before the best of them goes on."""

# Other friction than viscous takes some hundred times as long.
_EFFORT = {
    True: _Effort(10_000, 1e-6, 1e-8, 4, 1e-4, 7),
    False: _Effort(600, 0.03, 5e-5, 2, 3e-2, 3),
}


@dataclass(frozen=True)
class SweepResult:
    """What a sweep found.

    grid     the values of each decision
    found    all points evaluated, those on the lines where limits are active among them
    best     the best point of them that keeps all limits, None if none does
    refined  the best that smaller grids around the best few points led to
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

    points         evaluated, near the claimed optimum and all over
    best_speed     of the best point that keeps all limits, signed, m/s; NaN if none does
    best_gait      offset >= 0 where gaits at phi0 and -phi0 do equally well
    best_ratio     J20/J10, None: the robot as it is
    gap            (|claimed| - |best|)/|claimed|: negative where the sweep found something better
    speed          of the claimed gait, by the sweep's model, signed, m/s
    error          |speed - claimed|/|claimed|; NaN where the model cannot follow the gait's shape
    """

    points: int
    best_speed: float
    best_gait: SineGait | None
    best_ratio: float | None
    gap: float
    speed: float
    error: float

    @property
    def passed(self) -> bool:
        """Nothing better was found, and the claimed gait has the claimed speed."""
        return self.gap >= -TOLERATED and not self.error > TOLERATED


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
    widths = _spacing(grid)
    starts = [found.found(index) for index in _tops(found, widths, effort.climbs)]
    climbs = [zoom(problem, start, widths, effort.tolerance, _ROUGH) for start in starts]
    refined = _fastest([climb.best for climb in climbs])
    if refined is not None:
        closer = {name: 2 * _ROUGH * width for name, width in widths.items()}
        climbs.append(zoom(problem, refined, closer, effort.fine, effort.least))
        refined = climbs[-1].best
    return SweepResult(
        grid=grid,
        found=found,
        best=starts[0] if starts else None,
        refined=refined,
        points=found.speed.size + sum(climb.points for climb in climbs),
    )


def check_optimum(
    problem: Problem,
    gait: Gait,
    ratio: float | None,
    speed: float,
    counts: Mapping[str, int] | int | None = None,
    everywhere: SweepResult | None = None,
) -> SweepCheck:
    """Compare a claimed optimum with a sweep of the whole problem and a dense grid around it.

    A gait of another shape is compared with all sines, which no optimum of its family may fall
    short of.

    gait, ratio (J20/J10 in the problem's definition; read only if the problem has one) and
    signed speed (m/s) as claimed; counts as for `sweep`, or what it found where that is known.
    """
    effort = _EFFORT[model_of(problem.robot).viscous]
    if problem.inertia_ratio is None:
        ratio = None
    everywhere = everywhere or sweep(problem, counts)
    finalists, points = [everywhere.refined, everywhere.best], everywhere.points
    if isinstance(gait, SineGait):
        own = speeds(problem, gait.amplitude, gait.period, gait.offset, ratio, effort.fine)
        here = float(own.speed)
        centre = Found(_inside(problem, gait), ratio, here, float(own.peak_torque))
        near = zoom(
            problem, centre, _spacing(everywhere.grid), effort.fine, effort.least, effort.around
        )
        finalists, points = [*finalists, near.best], points + near.points
    else:
        here = speed_of(robot_with(problem, ratio), gait).speed
    # A grid of dry friction is coarse: what is compared with the claim is as fine as the claim.
    best = _fastest([one and _resolved(problem, one, _FINAL) for one in finalists])
    return compared(speed, here, best, points)


def compared(claimed: float, own: float, best: Found | None, points: int) -> SweepCheck:
    """A claimed speed compared with the model's own of that gait (both signed, m/s) and with
    the best that was found among `points`."""
    reached = math.nan if best is None else best.speed
    return SweepCheck(
        points=points,
        best_speed=reached,
        best_gait=best.gait if best else None,
        best_ratio=best.ratio if best else None,
        gap=(abs(claimed) - abs(reached)) / abs(claimed) if best else math.inf,
        speed=own,
        error=abs(own - claimed) / abs(claimed),
    )


def _counts(
    problem: Problem, counts: Mapping[str, int] | int | None, points: int
) -> Mapping[str, int]:
    free = free_decisions(problem)
    if counts is None:
        counts = max(4, math.ceil(points ** (1 / max(len(free), 1))))
    return dict.fromkeys(free, counts) if isinstance(counts, int) else counts


def _spacing(grid: Grid) -> dict[str, float]:
    """The widest gap between neighbours on the grid, by free decision."""
    return {name: float(np.diff(grid.axis(name)).max()) for name in grid.free}


def _tops(found: Evaluated, widths: Mapping[str, float], most: int) -> list[int]:
    """Indices of the best points that are two spacings or more from better ones, best first."""
    merit, chosen = found.merit, []
    apart = np.array([2.0 * widths.get(name, math.inf) for name in DECISIONS])[:, None]
    while merit.size and len(chosen) < most and merit.max() > -np.inf:
        top = int(merit.argmax())
        chosen.append(top)
        away = np.abs(found.decisions - found.decisions[:, [top]]) / apart
        merit = np.where(np.nanmax(away, axis=0) > 1, merit, -np.inf)
    return chosen


def _fastest(gaits: Sequence[Found | None]) -> Found | None:
    there = [one for one in gaits if one is not None]
    return max(there, key=lambda one: abs(one.speed), default=None)


def _resolved(problem: Problem, found: Found, tolerance: float) -> Found | None:
    """The same gait at this tolerance; None if that has no steady cycle or breaks the torque's
    limit."""
    gait = found.gait
    again = speeds(problem, gait.amplitude, gait.period, gait.offset, found.ratio, tolerance)
    torque = float(again.peak_torque)
    if not again.converged or torque > problem.limits.torque * (1 + 1e-4):
        return None
    return replace(found, speed=float(again.speed), peak_torque=torque)


def _inside(problem: Problem, gait: SineGait) -> SineGait:
    """The gait or its mirror image, whichever the sweep looks at."""
    if mirrored(problem):
        return SineGait(gait.amplitude, gait.period, abs(gait.offset))
    return gait
