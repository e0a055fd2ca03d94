"""The fastest gait of a problem, of every family of waveforms, and round a turn; each checked."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rr_opt.api.arguments import read_arguments
from rr_opt.api.identity import identity
from rr_opt.api.load import PathLike, problem_of
from rr_opt.design import maximize_speed as design
from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.turn import fastest_turn
from rr_opt.design.turn_target import Target, checked
from rr_opt.model.problem import Problem
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Progress, quiet
from rr_opt.results.shapes import FastestShapes, family_name
from rr_opt.results.turn import FastestTurn
from rr_opt.verify.replay import Replay, check_circle, replay
from rr_opt.verify.sweep import SweepCheck, SweepResult, check_optimum, sweep
from rr_opt.verify.turn_sweep import check_turn

if TYPE_CHECKING:
    from rr_opt.machines.racer.driven import DrivenOptimum


def maximize_speed(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestGait:
    """The fastest gait of a problem or its file, checked by simulation and against a plain sweep.

    Where no gait respects every limit, or a check fails, the result's `status` and `message` say
    so. Raises InputError for a robot without friction, which has no steady speed.
    """
    problem = problem_of(problem)
    optimum = design.maximize_speed(problem, progress)
    evidence = _evidence(optimum, progress)
    driven = _driven(optimum, progress)
    best = FastestGait(*identity(problem), optimum, *evidence, driven=driven)
    if optimum.best is None or not best.rebuilt:
        return best
    progress("the robot as built")
    as_built = design.maximize_speed(replace(problem, inertia_ratio=None)).best
    return replace(best, as_built=as_built.speed if as_built else None)


def _driven(optimum: Optimum, progress: Progress) -> DrivenOptimum | None:
    """The optimum driven with all effects of its robot, where the optimiser lacks some."""
    if not optimum.problem.robot.physics:
        return None
    from rr_opt.machines.racer.driven import drive_optimum

    progress("drive with all effects")
    return drive_optimum(optimum)


def _evidence(
    optimum: Optimum, progress: Progress, swept: SweepResult | None = None
) -> tuple[Replay | None, SweepCheck | None]:
    """The replay of an optimum and the sweep against it; None and None if there is no optimum.

    swept  a sweep of the whole problem, where that is done already
    """
    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    if best is None or robot is None or ratio is None:
        return None, None
    progress("replay by CVODES")
    replayed = replay(robot, best.gait, optimum.problem.limits, best.speed)
    progress("check against a sweep")
    check = check_optimum(optimum.problem, best.gait, ratio, best.speed, everywhere=swept)
    return replayed, check


def shapes(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestShapes:
    """The fastest sine, compared with the fastest gaits of 3 and 5 harmonics and of free shape.

    All respect the limits of the problem, whose own shape is ignored, and each is checked. Raises
    InputError for a robot without friction.
    """
    problem = problem_of(problem)
    name, sha256 = identity(problem)
    optima = design.compare_shapes(problem, progress)
    swept = None
    if any(one.best for one in optima):
        # One for all: it is a sweep of the sines, whatever the shape.
        progress("sweep of all sines")
        swept = sweep(problem)
    answers = []
    for one in optima:
        own = f"{name}, {family_name(one.problem.gait)}"
        evidence = _evidence(one, progress, swept)
        answers.append(FastestGait(own, sha256, one, *evidence, driven=_driven(one, progress)))
    return FastestShapes(name, sha256, tuple(answers))


def turn(
    problem: Problem | PathLike,
    *,
    radius: float | str | None = None,
    heading: float | str | None = None,
    within: float | str | None = None,
    length: float | str | None = None,
    whole: bool = False,
    progress: Progress = quiet,
) -> FastestTurn:
    """The fastest gait round a circle or through a change of heading, checked.

    radius   of the circle, m, positive to the left
    heading  change of heading, rad, positive to the left; with radius, within or length
    within   longest time for the change of heading, s
    length   longest path for it, m
    whole    make it in a whole number of periods

    Each is a number in SI or a text with its unit. Where the problem fixes the offset, it is freed.
    Raises InputError for what is no turn.
    """
    asked = {"radius": radius, "heading": heading, "within": within, "length": length}
    target = checked(Target(**read_arguments(asked), whole=whole))
    problem = problem_of(problem)
    name, sha256 = identity(problem)
    turned = fastest_turn(problem, target, progress)
    optimum, arc = turned.optimum, turned.arc
    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    found = FastestTurn(name, sha256, optimum, target=target, opened=turned.opened)
    if best is None or robot is None or ratio is None or arc is None:
        return found
    progress("replay by CVODES")
    replayed = replay(robot, best.gait, optimum.problem.limits, best.speed)
    progress("check against a sweep")
    swept = check_turn(optimum.problem, best.gait, ratio, best.speed)
    progress("check of the circle")
    wanted = target.turn.curvature
    circle = check_circle(robot, best.gait, wanted.low if wanted.fixed else arc.curvature)
    driven = _driven(optimum, progress)
    return replace(found, replay=replayed, sweep=swept, arc=arc, circle=circle, driven=driven)
