"""Turns: the fastest gait for one, checked, and the chart of the turns that a robot can make."""

from dataclasses import replace

from rr_opt.api.load import PathLike, identity, problem_of, read_arguments
from rr_opt.api.optimise import checked_optimum, driven_optimum, require_exact, require_known
from rr_opt.design.turn import Target, arc_of, checked, fastest_turn
from rr_opt.model.problem import Problem
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.servo import servo_limited
from rr_opt.results.result import Progress, quiet
from rr_opt.results.turn import FastestTurn, TurnChart
from rr_opt.verify.replay import check_circle
from rr_opt.verify.turn_chart import radius_claim, sign_claim, tightest, turn_map


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

    Each is a number in SI or a text with its unit. If the problem fixes the offset, it is freed.
    Raises InputError for an invalid turn.
    """
    asked = {"radius": radius, "heading": heading, "within": within, "length": length}
    target = checked(Target(**read_arguments(asked), whole=whole))
    problem = problem_of(problem)
    require_known(problem)
    require_exact(problem)
    name, sha256 = identity(problem)
    turned = fastest_turn(problem, target, progress)
    optimum, replayed, swept = checked_optimum(turned.optimum, progress)
    best, robot, arc = optimum.best, optimum.robot, arc_of(optimum, target.heading)
    found = FastestTurn(name, sha256, optimum, target=target, opened=turned.opened)
    if best is None or robot is None or arc is None:
        return found
    progress("check of the circle")
    wanted = target.turn.curvature
    circle = check_circle(robot, best.gait, wanted.low if wanted.fixed else arc.curvature)
    driven = driven_optimum(optimum, progress)
    return replace(found, replay=replayed, sweep=swept, arc=arc, circle=circle, driven=driven)


_DRAWN = (6, 4, 121)
"""Amplitudes, periods and offsets of the chart."""
_TESTED = (24, 10, 101)
"""The same for the map on which the paper's claim is tested."""


def turn_chart(problem: Problem | PathLike, *, progress: Progress = quiet) -> TurnChart:
    """Radius over offset, amplitude and period, and the tightest circle within the limits.

    The inertia ratio is that of the robot as it is. Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    posed = servo_limited(problem)
    progress("chart")
    seen = turn_map(posed, _DRAWN)
    progress("the paper's claim")
    fine = turn_map(posed, _TESTED)
    progress("tightest circle")
    tight = tightest(posed)
    claims = sign_claim(fine), radius_claim(fine)
    return TurnChart(*identity(problem), posed, seen, tight, *claims)
