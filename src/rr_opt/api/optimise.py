"""Gaits of a problem: the fastest, and the fastest of each waveform, checked; sweeps."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from rr_opt.api.load import PathLike, identity, problem_of
from rr_opt.design import maximize_speed as design
from rr_opt.design.decisions import decisions
from rr_opt.design.infeasible import posture_clashes
from rr_opt.design.maximize_speed import Optimum
from rr_opt.messages import listed
from rr_opt.model.problem import Problem
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.servo import servo_limited
from rr_opt.outcome import InputError, Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Progress, quiet
from rr_opt.results.shapes import FastestShapes, family
from rr_opt.results.sweep import Sweep
from rr_opt.verify import sweep as verify
from rr_opt.verify.grid import free_decisions
from rr_opt.verify.replay import Replay, replay
from rr_opt.verify.sweep import SweepCheck, SweepResult, check_optimum

if TYPE_CHECKING:
    from rr_opt.machines.racer.driven import DrivenOptimum


def maximize_speed(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestGait:
    """The best gait of a problem or its file, checked by simulation and against a plain sweep: the
    fastest, or that of the least cost of transport.

    If no gait respects every limit, or a check fails, the result's `status` and `message` say so.
    With `robust` it also has the gait that is fast across the robot's uncertainty. Raises
    InputError for a robot without friction, which has no steady speed.
    """
    problem = problem_of(problem)
    require_known(problem)
    optimum, replayed, swept = checked_optimum(design.maximize_speed(problem, progress), progress)
    driven = driven_optimum(optimum, progress)
    best = FastestGait(*identity(problem), optimum, replayed, swept, driven=driven)
    if problem.robust and best.gait is not None:
        from rr_opt.results.robust import robust_answer

        progress("the robust gait")
        best = replace(best, robust=robust_answer(best, problem.robust))
    if optimum.best is None or not best.rebuilt:
        return best
    progress("the robot as built")
    as_built = design.maximize_speed(replace(problem, inertia_ratio=None)).best
    return replace(best, as_built=as_built.speed if as_built else None)


def require_known(problem: Problem) -> None:
    """Raise InputError for an energy criterion if the optimiser lacks an effect on it."""
    if not (problem.economy and problem.robot.physics):
        return
    from rr_opt.machines.racer.driven import beyond_optimiser

    if names := beyond_optimiser(problem.robot):
        raise InputError(
            f"Read {listed(names)} in the robot's physics with `objective: cost_of_transport` or "
            "one of the limits power, cost_of_transport and speed. The optimiser has no energy "
            "model for a robot with such effects. Leave them out, or optimise the speed alone."
        )


def driven_optimum(optimum: Optimum, progress: Progress) -> DrivenOptimum | None:
    """The optimum driven with all effects of its robot, if the optimiser lacks some."""
    if not optimum.problem.robot.physics:
        return None
    from rr_opt.machines.racer.driven import drive_optimum

    progress("drive with all effects")
    return drive_optimum(optimum)


def require_exact(problem: Problem) -> None:
    """Raise InputError if robust gaits are requested that only `maximize_speed` supports."""
    if problem.robust:
        raise InputError(
            "Read `robust` in the problem. Robust gaits are found by `maximize-speed` only, not "
            "for turns, other shapes or studies. Leave it out here."
        )


_RESUMED = 2
"""Most further climbs from a better gait of the sweep."""


def checked_optimum(
    optimum: Optimum, progress: Progress, swept: SweepResult | None = None
) -> tuple[Optimum, Replay | None, SweepCheck | None]:
    """The optimum with its replay and the sweep against it; None and None if there is no gait.

    If the sweep found a better gait, the optimiser climbs on from there, and the result is checked
    instead.

    swept  a sweep of the whole problem, if available
    """
    if optimum.best is None and optimum.problem.gait.shape != "sine":
        return optimum, None, None
    progress("check against a sweep")
    swept = swept or verify.sweep(optimum.problem)
    check = _held(optimum, swept)
    for _ in range(_RESUMED):
        better = check.better if check else swept.refined
        if better is None:
            break
        progress("restart from a gait that the sweep found")
        climbed = design.resumed(optimum, better.gait, better.ratio)
        if climbed is optimum:
            break
        optimum, check = climbed, _held(climbed, swept)
    if optimum.best is None or optimum.robot is None:
        proved = posture_clashes(optimum.problem, decisions(optimum.problem))
        if optimum.status is Status.INFEASIBLE and not proved:
            second = f" A sweep of {swept.points} gaits with another model finds none either."
            optimum = replace(optimum, message=optimum.message + second)
        return optimum, None, None
    progress("replay by CVODES")
    replayed = replay(optimum.robot, optimum.best.gait, optimum.problem.limits, optimum.best.speed)
    return optimum, replayed, check


def _held(optimum: Optimum, swept: SweepResult) -> SweepCheck | None:
    if optimum.best is None:
        return None
    best, posed = optimum.best, optimum.problem
    cost = best.cost or math.nan
    return check_optimum(posed, best.gait, optimum.ratio, best.speed, everywhere=swept, cost=cost)


def shapes(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestShapes:
    """The fastest sine, compared with the fastest gaits of 3 and 5 harmonics and of free shape.

    All respect the limits of the problem, whose own shape is ignored, and each is checked. Raises
    InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_exact(problem)
    name, sha256 = identity(problem)
    optima = design.compare_shapes(problem, progress)
    swept = None
    if any(one.best for one in optima):
        # One for all: it sweeps the sines, whatever the shape, as the optima are posed.
        progress("sweep of all sines")
        swept = verify.sweep(optima[0].problem)
    answers = []
    for one in optima:
        own = f"{name}, {family(one)}"
        optimum, replayed, check = checked_optimum(one, progress, swept)
        driven = driven_optimum(optimum, progress)
        answers.append(FastestGait(own, sha256, optimum, replayed, check, driven=driven))
    return FastestShapes(name, sha256, tuple(answers))


def sweep(
    problem: Problem | PathLike, points: int = 10_000, *, progress: Progress = quiet
) -> Sweep:
    """Evaluate about `points` gaits over the whole bounds, and refine the best.

    Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    posed = servo_limited(problem)
    counts = max(2, math.ceil(points ** (1 / max(len(free_decisions(posed)), 1))))
    tried = verify.sweep(posed, counts, lambda done, of: progress(f"gait {done} of {of}"))
    return Sweep(*identity(problem), posed, tried)
