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

from rr_opt.design.decisions import decisions
from rr_opt.design.infeasible import direction_clash, posture_clashes, torque_clash
from rr_opt.design.ranking import distinct
from rr_opt.design.refine import refine, solve_from
from rr_opt.design.seeds import Seed, find_seeds
from rr_opt.design.setting import Setting, robot_of, scanned, settings_of
from rr_opt.design.solve import Candidate
from rr_opt.outcome import NotConvergedError, Status
from rr_opt.physics.dynamics import require_friction
from rr_opt.problem import Problem
from rr_opt.robot.ballast import inertia_ratio
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

Progress = Callable[[str], None]

SAME_SPEED = 1e-5
"""Optima whose speeds differ by less, relative, are a tie."""


@dataclass(frozen=True)
class Optimum:
    """The answer to a problem.

    best        the winner; None unless status is OPTIMAL
    robot       the robot with the winner's inertia ratio
    ratio       its J20/J10, in the problem's definition (about P if the problem has none)
    optima      the distinct optima found that are at least half as fast as the best, best first;
                ties are those within SAME_SPEED of the first
    sideways    the best gait sits where forward turns into backward: its mean velocity is at
                right angles to its mean heading, and its direction a matter of definition
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
    def sideways(self) -> bool:
        """See above."""
        return self.best is not None and abs(self.best.prices["direction"]) > 1e-3

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
    require_friction(problem.robot)
    box = decisions(problem)
    clash = posture_clashes(problem, box)
    if clash:
        return Optimum(Status.INFEASIBLE, clash, problem)
    progress("scanning for starts")
    signs = {"forward": (1,), "backward": (-1,), "either": (1, -1)}[problem.direction]
    settings = settings_of(problem, box)
    starts: list[tuple[Setting, Seed]] = []
    fastest = -math.inf
    for setting in settings:
        inside = scanned(setting, box)
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
            found.append((setting, solve_from(setting, seed.sign, gait, share)))
        except NotConvergedError as error:
            lost.append(str(error))
    optimum = _answer(problem, found, lost, progress)
    if optimum.status is Status.NOT_CONVERGED:
        landscapes = [setting.landscape for setting in settings]
        clash = torque_clash(problem, box, landscapes) or direction_clash(problem, fastest)
        if clash:
            return replace(optimum, status=Status.INFEASIBLE, message=clash)
    return optimum


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
    good = distinct(sorted(good, key=lambda pair: pair[1].rank))
    while good:
        setting, best = good[0]
        progress("refining the best")
        refined = refine(setting, best)
        iterations += refined.iterations - best.iterations
        if not (refined.feasible and refined.success):
            failures += (refined.sentence,)
            good.pop(0)
            continue
        good = distinct([(setting, refined), *good[1:]])
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
