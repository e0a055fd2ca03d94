"""The fastest gait of a problem: scan, solve from every promising start, rank, refine.

Local optima are many, some on limits and some at the edge of the singular posture. The scan
finds their basins; multiple shooting finds each optimum; they are ranked by feasibility,
success and speed, in this order. The winner is solved again on a mesh whose accuracy was
checked and whose nodes lie where the torque peaks, so that limits hold between the nodes too.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.decisions import Decisions, decisions
from rr_opt.design.infeasible import direction_clash, posture_clashes, torque_clash
from rr_opt.design.landscape import Landscape
from rr_opt.design.mesh import LADDER, Dense, dense, mesh_for, with_nodes_at
from rr_opt.design.seeds import Seed, find_seeds
from rr_opt.design.solve import Candidate, Setting, solve
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import NotConvergedError, Status
from rr_opt.physics.dynamics import dynamics_of
from rr_opt.problem import Interval, Problem
from rr_opt.robot.ballast import Loads, inertia_ratio, with_load_count
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]
Progress = Callable[[str], None]

TRIAL = 36
SAME_SPEED = 1e-5
"""Optima whose speeds differ by less, relative, are one or a tie."""

_CLAIM = 3e-7
_PEAK = 1e-6
_REFINEMENTS = 8


@dataclass(frozen=True)
class Optimum:
    """The answer to a problem.

    best        the winner; None unless status is OPTIMAL
    robot       the robot with the winner's inertia ratio
    ratio       its J20/J10, in the problem's definition (about P if the problem has none)
    optima      all distinct optima, best first; ties are those within SAME_SPEED of the first
    starts      starts solved; iterations and failures over all of them
    intervals   mesh of the winner
    """

    status: Status
    message: str
    problem: Problem
    best: Candidate | None = None
    robot: Robot | None = None
    ratio: float | None = None
    optima: tuple[Candidate, ...] = ()
    starts: int = 0
    iterations: int = 0
    failures: tuple[str, ...] = ()
    intervals: int = 0

    @property
    def ties(self) -> tuple[Candidate, ...]:
        """Other optima as fast as the best, within what is told apart."""
        if self.best is None:
            return ()
        least = abs(self.best.speed) * (1 - SAME_SPEED)
        return tuple(one for one in self.optima[1:] if abs(one.speed) >= least)


def maximize_speed(problem: Problem, progress: Progress = lambda _: None) -> Optimum:
    """Solve a gait problem.

    Returns an Optimum whose status is OPTIMAL, INFEASIBLE (the message names the limits that
    clash and how far each must give) or NOT_CONVERGED; never a failure dressed as a solution.
    Raises InputError for a robot that has no steady cycle to find.
    """
    box = decisions(problem)
    clash = posture_clashes(problem, box)
    if clash:
        return Optimum(Status.INFEASIBLE, clash, problem)
    progress("scanning for starts")
    signs = {"forward": (1,), "backward": (-1,), "either": (1, -1)}[problem.direction]
    settings = _settings(problem, box)
    starts: list[tuple[Setting, Seed]] = []
    fastest = -math.inf
    for setting in settings:
        inside = _scanned(setting, box)
        seeds, best = find_seeds(setting.landscape, inside, problem.limits.torque, signs)
        starts += [(setting, seed) for seed in seeds]
        fastest = max(fastest, best)
    found: list[tuple[Setting, Candidate]] = []
    lost: list[str] = []
    for number, (setting, seed) in enumerate(starts, 1):
        progress(f"start {number} of {len(starts)}")
        amplitude, period, offset, share = map(float, box.physical(seed.point[None])[:, 0])
        if setting.fixed_share is not None:
            share = setting.fixed_share
        gait = SineGait(amplitude, period, offset)
        try:
            found.append((setting, _solve(setting, seed.sign, gait, share)))
        except NotConvergedError as error:
            lost.append(str(error))
    optimum = _answer(problem, found, lost, progress)
    if optimum.status is Status.NOT_CONVERGED:
        landscapes = [setting.landscape for setting in settings]
        clash = torque_clash(problem, box, landscapes) or direction_clash(problem, fastest)
        if clash:
            return replace(optimum, status=Status.INFEASIBLE, message=clash)
    return optimum


def _solve(setting: Setting, sign: int, gait: SineGait, share: float) -> Candidate:
    """Solve from a gait on a mesh that is fine enough for its cycle."""
    robot = robot_of(setting, share)
    seen = dense(setting.landscape, robot, gait, share)
    try:
        coarse = steady_cycle(robot, gait, steps=TRIAL).speed
        error = abs(coarse - seen.speed) / abs(seen.speed)
        intervals = mesh_for(TRIAL, error, _CLAIM / 2)
    except NotConvergedError:  # dry friction too steep for so coarse a mesh
        intervals = LADDER[-1]
    return solve(setting, sign, gait, share, _phases(setting, intervals, seen))


def _phases(setting: Setting, intervals: int, seen: Dense) -> Array:
    """Equal phases, with nodes moved onto the torque's peaks where its limit is near."""
    near = seen.peak > 0.97 * setting.problem.limits.torque
    return with_nodes_at(intervals, seen.peaks if near else np.array([]))


def _answer(
    problem: Problem,
    found: list[tuple[Setting, Candidate]],
    lost: list[str],
    progress: Progress,
) -> Optimum:
    iterations = sum(candidate.iterations for _, candidate in found)
    failures = (
        *lost,
        *(one.sentence for _, one in found if not (one.feasible and one.success)),
    )
    good = [pair for pair in found if pair[1].feasible and pair[1].success]
    good = _distinct(sorted(good, key=lambda pair: pair[1].rank))
    while good:
        setting, best = good[0]
        progress("refining the best")
        refined = _refine(setting, best)
        iterations += refined.iterations - best.iterations
        if not (refined.feasible and refined.success):
            failures += (refined.sentence,)
            good.pop(0)
            continue
        good = _distinct([(setting, refined), *good[1:]])
        others = good[1:]
        # A coarse mesh can put a close second first: it is refined too before the choice falls.
        if others and abs(others[0][1].speed) > abs(refined.speed):
            good = sorted(good, key=lambda pair: pair[1].rank)
            continue
        robot = robot_of(setting, refined.share)
        about = problem.inertia_ratio.about if problem.inertia_ratio else "joint"
        return Optimum(
            Status.OPTIMAL,
            refined.sentence,
            problem,
            best=refined,
            robot=robot,
            ratio=inertia_ratio(robot, about),
            optima=(refined, *(candidate for _, candidate in others)),
            starts=len(found) + len(lost),
            iterations=iterations,
            failures=failures,
            intervals=len(refined.phases),
        )
    message = "No start led to an optimum. " + " ".join(dict.fromkeys(failures))
    return Optimum(
        Status.NOT_CONVERGED,
        message,
        problem,
        starts=len(found) + len(lost),
        iterations=iterations,
        failures=failures,
    )


def _settings(problem: Problem, box: Decisions) -> list[Setting]:
    """One setting, or one for each whole number of loads."""
    choice = problem.inertia_ratio
    by, loads = (choice.by, choice.loads) if choice else ("inertia", Loads())
    dynamics = dynamics_of(problem.robot)
    low, high = box.ballast.low, box.ballast.high
    landscape = Landscape(dynamics, problem.robot, by, loads, box.ballast)
    setting = Setting(problem, dynamics, landscape, box.ballast)
    if not (by == "loads" and loads.whole):
        return [setting]
    counts = range(math.ceil(low - 1e-9), math.floor(high + 1e-9) + 1)
    width = (high - low) or 1.0
    return [replace(setting, fixed_share=(count - low) / width) for count in counts]


def _scanned(setting: Setting, box: Decisions) -> Decisions:
    """The box to scan: with a whole number of loads the ballast is not free."""
    if setting.fixed_share is None:
        return box
    count = box.ballast.low + setting.fixed_share * (box.ballast.high - box.ballast.low)
    return replace(box, ballast=Interval(count, count))


def robot_of(setting: Setting, share: float) -> Robot:
    """The problem's robot with the ballast at this share of its range."""
    robot, choice, ballast = setting.problem.robot, setting.problem.inertia_ratio, setting.ballast
    amount = ballast.low + share * (ballast.high - ballast.low)
    if choice and choice.by == "loads":
        return replace(robot, platform2=with_load_count(robot.platform2, choice.loads, amount))
    return replace(robot, platform2=replace(robot.platform2, I=amount))


def _distinct(ranked: list[tuple[Setting, Candidate]]) -> list[tuple[Setting, Candidate]]:
    """One of each optimum; a gait and its mirror image (phi0 and -phi0) are one."""
    kept: list[tuple[Setting, Candidate]] = []
    for setting, one in ranked:
        if not any(setting is other and _same(one, twin) for other, twin in kept):
            kept.append((setting, one))
    return kept


def _same(one: Candidate, other: Candidate) -> bool:
    """Before their meshes are refined, two finds of one optimum differ a little."""
    a, b = one.gait, other.gait
    return (
        one.sign == other.sign
        and math.isclose(one.speed, other.speed, rel_tol=1e-3)
        and math.isclose(a.amplitude, b.amplitude, rel_tol=1e-2)
        and math.isclose(a.period, b.period, rel_tol=1e-2)
        and math.isclose(abs(a.offset), abs(b.offset), abs_tol=1e-2)
        and math.isclose(one.share, other.share, abs_tol=1e-2)
    )


def _refine(setting: Setting, candidate: Candidate) -> Candidate:
    """Solve again until the mesh claims the true speed and no torque peaks between nodes."""
    limit = setting.problem.limits.torque
    iterations = candidate.iterations
    for _ in range(_REFINEMENTS):
        gait, share = candidate.gait, candidate.share
        seen = dense(setting.landscape, robot_of(setting, share), gait, share)
        error = abs(abs(candidate.speed) - abs(seen.speed)) / abs(seen.speed)
        if error <= _CLAIM and seen.peak <= limit * (1 + _PEAK):
            break
        intervals = len(candidate.phases)
        if error > _CLAIM:
            intervals = mesh_for(intervals, error, _CLAIM / 4)
        candidate = solve(setting, candidate.sign, gait, share, _phases(setting, intervals, seen))
        iterations += candidate.iterations
        if not (candidate.feasible and candidate.success):
            break
    return replace(candidate, iterations=iterations)
