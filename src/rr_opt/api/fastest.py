"""The fastest gait of a problem, of every family of shapes, and round a turn; each checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from rr_opt.answers.shapes import ShapesAnswer, family_name
from rr_opt.answers.speed import SpeedAnswer, evidence
from rr_opt.answers.turn import TurnAnswer
from rr_opt.api.arguments import read_arguments
from rr_opt.api.identity import identity
from rr_opt.api.load import PathLike, problem_of
from rr_opt.api.result import Plots, Progress, Result, quiet
from rr_opt.design import maximize_speed as design
from rr_opt.design.turn import fastest_turn
from rr_opt.design.turn_target import Target, checked
from rr_opt.model.problem import Problem
from rr_opt.verify.replay import check_circle, replay
from rr_opt.verify.sweep import sweep
from rr_opt.verify.turn_sweep import check_turn


class FastestGait(Result, SpeedAnswer):
    """The fastest gait of a problem, with the evidence for it.

    speed, gait, robot, inertia_ratio   None without a gait, but for the robot
    as_built the speed at best without a change of the inertia ratio, where it was to be chosen
    limits   by name (angle, rate, torque, singularity), each with `limit`, `value`, `active` and
             `shadow_price`, SI
    bounds   the same of amplitude, period, offset and inertia_ratio
    replay   the motion simulated by CVODES
    sweep    the comparison with a plain sweep
    """

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of result.json."""
        from rr_opt.report.result import result

        return result(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """Gait, speed, limits and checks as text."""
        from rr_opt.report.speed import summary

        return summary(self, files)

    def plot(self) -> Plots:
        """Speed map (of a sine), path, cycle, and what each limit is worth."""
        from rr_opt.report.figures.speed import draw

        return Plots(draw(self))

    def _write(self, folder: Path, figures: bool, progress: Progress) -> list[Path]:
        from rr_opt.report.speed import write_results

        return write_results(self, folder, figures=figures, progress=progress)


def maximize_speed(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestGait:
    """The fastest gait of a problem or its file, checked by simulation and against a plain sweep.

    Where no gait keeps every limit, or a check fails, the result's `status` and `message` say so.
    Raises InputError for a robot without friction, which has no steady speed.
    """
    problem = problem_of(problem)
    optimum = design.maximize_speed(problem, progress)
    best = FastestGait(*identity(problem), optimum, *evidence(optimum, progress))
    if optimum.best is None or not best.rebuilt:
        return best
    progress("the robot as built")
    as_built = design.maximize_speed(replace(problem, inertia_ratio=None)).best
    return replace(best, as_built=as_built.speed if as_built else None)


class FastestShapes(Result, ShapesAnswer):
    """The fastest gait of each family of shapes under the same limits.

    answers   a FastestGait for the sine, 3 and 5 harmonics, and a free gait
    """

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of shapes.json."""
        from rr_opt.report.shapes import record

        return record(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """A line for each family."""
        from rr_opt.report.shapes import summary

        return summary(self, files)

    def plot(self) -> Plots:
        """The gaits of all families."""
        from rr_opt.report.figures.shapes import draw

        return Plots({"shapes": drawn} if (drawn := draw(self)) else {})

    def _write(self, folder: Path, figures: bool, progress: Progress) -> list[Path]:
        from rr_opt.report.shapes import write_shapes

        return write_shapes(self, folder, figures=figures, progress=progress)


def shapes(problem: Problem | PathLike, *, progress: Progress = quiet) -> FastestShapes:
    """The fastest sine beside the fastest gaits of 3 and 5 harmonics and of free shape.

    All keep the limits of the problem, whose own shape is ignored, and each is checked. Raises
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
    return FastestShapes(
        name,
        sha256,
        tuple(
            FastestGait(
                f"{name}, {family_name(optimum.problem.gait)}",
                sha256,
                optimum,
                *evidence(optimum, progress, swept),
            )
            for optimum in optima
        ),
    )


class FastestTurn(Result, TurnAnswer):
    """The fastest gait that makes a turn: as FastestGait, and

    arc      heading, curvature, time and length of the turn
    radius   of the circle, m
    circle   whether the robot stays on it, and comes to it from rest
    """

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of result.json."""
        from rr_opt.report.turn import turn_result

        return turn_result(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The turn, its gait, limits and checks as text."""
        from rr_opt.report.turn import turn_summary

        return turn_summary(self, files)

    def plot(self) -> Plots:
        """As of any fastest gait."""
        from rr_opt.report.figures.speed import draw

        return Plots(draw(self))

    def _write(self, folder: Path, figures: bool, progress: Progress) -> list[Path]:
        from rr_opt.report.turn import write_turn

        return write_turn(self, folder, figures=figures, progress=progress)


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
    within   time that the change of heading may take, s
    length   path that it may take, m
    whole    a whole number of periods makes it

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
    found = {"target": target, "opened": turned.opened}
    if best is None or robot is None or ratio is None or arc is None:
        return FastestTurn(name, sha256, optimum, **found)
    progress("replay by CVODES")
    replayed = replay(robot, best.gait, optimum.problem.limits, best.speed)
    progress("check against a sweep")
    swept = check_turn(optimum.problem, best.gait, ratio, best.speed)
    progress("check of the circle")
    wanted = target.turn.curvature
    circle = check_circle(robot, best.gait, wanted.low if wanted.fixed else arc.curvature)
    return FastestTurn(name, sha256, optimum, replayed, swept, arc=arc, circle=circle, **found)
