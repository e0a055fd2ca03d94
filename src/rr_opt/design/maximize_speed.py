"""The fastest gait of a problem: find the optima of its family, rank them, refine the best.

There are many local optima, some on limits and some near the singular posture. The scan finds
their basins; multiple shooting finds each optimum; they are ranked by feasibility, convergence and
speed, in this order. The winner is re-solved on a mesh of verified accuracy with nodes where the
torque peaks, so that limits hold between the nodes too.
"""

from dataclasses import dataclass, replace

import numpy as np

from rr_opt.design.candidate import Finds, StartResult, distinct
from rr_opt.design.decisions import decisions, robot_of, settings_of, share_of
from rr_opt.design.families import Progress, find_families, find_sines, refine
from rr_opt.design.sines import WAYS, solve_sine
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.servo import for_joint
from rr_opt.outcome import InputError, Status

SAME_SPEED = 1e-5
"""Optima whose speeds differ by less, relative, are a tie."""


COMPARED = (3, 5)
"""Numbers of harmonics compared with the sine and the free gait."""


@dataclass(frozen=True)
class Optimum:
    """The answer to a problem.

    problem     in terms of the joint motion, as are `best` and `optima`
    best        the winner; None unless status is OPTIMAL
    robot       the robot with the winner's inertia ratio
    ratio       its J20/J10, in the problem's definition (about P if the problem has none)
    optima      the distinct optima found that are at least half as fast as the best, best first;
                ties are those within SAME_SPEED of the first
    sideways    the best gait is on the boundary between forward and backward: its mean velocity is
                perpendicular to its mean heading, so its direction is a matter of definition
    starts      starts solved; iterations and failures over all of them
    intervals   mesh of the winner
    sine        speed of the best sine, where the problem asks for another shape, m/s
    """

    status: Status
    message: str
    problem: Problem
    best: StartResult | None = None
    robot: Robot | None = None
    ratio: float | None = None
    optima: tuple[StartResult, ...] = ()
    starts: int = 0
    iterations: int = 0
    failures: tuple[str, ...] = ()
    intervals: int = 0
    sine: float | None = None

    @property
    def sideways(self) -> bool:
        """Whether the best gait drives sideways; see the class."""
        return self.best is not None and abs(self.best.prices["direction"]) > 1e-3

    @property
    def ties(self) -> tuple[StartResult, ...]:
        """Other optima as fast as the best, within the resolution."""
        if self.best is None:
            return ()
        least = self.best.merit * (1 - SAME_SPEED)
        return tuple(one for one in self.optima[1:] if one.merit >= least)


def maximize_speed(problem: Problem, progress: Progress = lambda _: None) -> Optimum:
    """Solve a gait problem.

    Returns an Optimum whose status is OPTIMAL, INFEASIBLE (the message names the limits that
    conflict and by how much each must change) or NOT_CONVERGED; a failure is never returned as a
    solution. Raises InputError for a robot without a steady cycle.
    """
    require_friction(problem.robot)
    _require_speed(problem)
    problem = for_joint(problem)
    if problem.gait.shape == "sine":
        return _answer(problem, find_sines(problem, progress), progress)
    finds = [found for _, found in find_families(problem, progress)]
    optimum = _answer(problem, finds[-1], progress)
    return replace(optimum, sine=finds[0].fastest or None)


def resumed(optimum: Optimum, gait: SineGait, ratio: float | None) -> Optimum:
    """The optimum, or a better one reached from a sine that was found elsewhere; ratio: its
    J20/J10, None: the robot as it is."""
    problem = optimum.problem
    if problem.gait.shape != "sine":
        return optimum
    box = decisions(problem)
    start = np.array([gait.amplitude, gait.period, gait.offset, share_of(problem, box, ratio)])
    settings = settings_of(problem, box)
    setting = min(settings, key=lambda one: abs((one.fixed_share or 0.0) - start[3]))
    climbed = solve_sine(setting, WAYS[problem.direction], start)
    again = _answer(problem, Finds([(setting, climbed)]), lambda _: None)
    if again.best is None or (optimum.best and again.best.merit <= optimum.best.merit):
        return optimum
    return replace(
        again,
        optima=(again.best, *optimum.optima),
        starts=optimum.starts + 1,
        iterations=optimum.iterations + again.iterations,
        failures=optimum.failures,
    )


def _require_speed(problem: Problem) -> None:
    """Raise InputError for an energy criterion that the optimiser cannot handle."""
    if problem.economy and problem.gait.shape != "sine":
        raise InputError(
            f"Read a `{problem.gait.shape}` gait with `objective: cost_of_transport` or one of the "
            "limits power, cost_of_transport and speed. Only sines are optimised with these. "
            "Write `shape: sine`, or leave them out."
        )


def compare_shapes(problem: Problem, progress: Progress = lambda _: None) -> list[Optimum]:
    """The optimum among sines, then among COMPARED harmonics, then among free gaits."""
    require_friction(problem.robot)
    problem = for_joint(problem)
    free = replace(problem, gait=replace(problem.gait, shape="free"))
    _require_speed(free)
    families = find_families(free, progress, COMPARED)
    return [_answer(posed, finds, progress) for posed, finds in families]


def _answer(problem: Problem, finds: Finds, progress: Progress) -> Optimum:
    iterations = sum(one.iterations for _, one in finds.pairs)
    starts = len(finds.pairs) + len(finds.lost)
    failures = (
        *finds.lost,
        *(one.sentence for _, one in finds.pairs if not (one.feasible and one.success)),
    )
    good = distinct(finds.good)
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
        # On a coarse mesh a runner-up may rank first: refine it too before choosing.
        if others and others[0][1].merit > refined.merit:
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
            starts=starts,
            iterations=iterations,
            failures=failures,
            intervals=refined.intervals,
        )
    message = finds.clash or "No start led to an optimum. " + " ".join(dict.fromkeys(failures))
    return Optimum(
        Status.INFEASIBLE if finds.clash else Status.NOT_CONVERGED,
        message,
        problem,
        starts=starts,
        iterations=iterations,
        failures=failures,
    )
