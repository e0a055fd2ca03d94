"""`rr-opt turn [PROBLEM]`: the gait that turns fastest round a circle or through an angle."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rr_opt.cli.options import Figures, ProblemFile, json_option, out_option
from rr_opt.cli.problem_input import name_of, read
from rr_opt.cli.steps import Steps
from rr_opt.outcome import InputError, Status

if TYPE_CHECKING:
    from rr_opt.answers.turn import TurnAnswer
    from rr_opt.design.turn.target import Target
    from rr_opt.model.problem import Problem


class Cycles(StrEnum):
    """How many periods the heading change may take."""

    ANY = "any"
    WHOLE = "whole"


def turn(
    problem: ProblemFile = None,
    *,
    radius: Annotated[
        str | None,
        typer.Option(help="Radius of the circle, m, or with a unit; positive to the left."),
    ] = None,
    heading: Annotated[
        str | None,
        typer.Option(
            help="Change of heading, rad, or with a unit: '90 deg'; positive to the left."
        ),
    ] = None,
    within: Annotated[
        str | None, typer.Option(help="Time that the heading change may take, s.")
    ] = None,
    length: Annotated[
        str | None, typer.Option(help="Path that the heading change may take, m.")
    ] = None,
    cycles: Annotated[
        Cycles, typer.Option(help="whole: a whole number of periods makes the heading change.")
    ] = Cycles.ANY,
    out: Annotated[Path | None, out_option("out/NAME-turn")] = None,
    json: Annotated[bool, json_option("result.json")] = False,
    figures: Figures = True,
) -> None:
    """Find the gait that turns fastest.

    Give --radius; or --heading with --radius, --within or --length. Left is positive, seen from
    above, whichever way the robot drives; the problem says which way it may.
    """
    with Steps() as steps:
        steps("reading")
        target = _target(radius, heading, within, length, cycles)
        posed, sha256 = read(problem)
        from rr_opt.report.archive import folder_for_results, strict_json

        name = name_of(problem)
        folder = folder_for_results(out or Path("out") / f"{name}-turn")
        answer = _answer(posed, target, name, sha256, steps)
        from rr_opt.report.turn.summary import turn_result, turn_summary, write_turn

        written = write_turn(answer, folder, figures=figures, progress=steps)
    if json:
        typer.echo(strict_json(turn_result(answer)), nl=False)
    else:
        typer.echo(turn_summary(answer, written), nl=False)
    if answer.status is not Status.OPTIMAL:
        typer.echo(answer.message, err=True)
        raise typer.Exit(answer.status.exit_code)


def _target(
    radius: str | None, heading: str | None, within: str | None, length: str | None, cycles: Cycles
) -> Target:
    """What is asked. Raises InputError with everything that is wrong with the values."""
    from rr_opt.design.turn.target import Target, checked
    from rr_opt.units import Quantity

    values: dict[str, float] = {}
    wrong = []
    for name, text, kind in (
        ("radius", radius, Quantity("m", "1.5 m")),
        ("heading", heading, Quantity("rad", "90 deg")),
        ("within", within, Quantity("s", "4 s", above=0)),
        ("length", length, Quantity("m", "80 cm", above=0)),
    ):
        if text is not None:
            try:
                values[name] = kind.read(text)
            except InputError as error:
                wrong.append(f"--{name}: {error}")
    if wrong:
        raise InputError("\n".join(wrong))
    return checked(Target(**values, whole=cycles is Cycles.WHOLE))


def _answer(problem: Problem, target: Target, name: str, sha256: str, steps: Steps) -> TurnAnswer:
    """Find the turn, then check it: by simulation, against a sweep, and on its circle."""
    from rr_opt.answers.turn import TurnAnswer
    from rr_opt.design.turn.fastest_turn import fastest_turn
    from rr_opt.verify.replay import replay
    from rr_opt.verify.turn.circle import check_circle
    from rr_opt.verify.turn.sweep import check_turn

    turned = fastest_turn(problem, target, steps)
    optimum, arc = turned.optimum, turned.arc
    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    told = {"target": target, "opened": turned.opened}
    if best is None or robot is None or ratio is None or arc is None:
        return TurnAnswer(name, sha256, optimum, **told)
    steps("replay by CVODES")
    replayed = replay(robot, best.gait, optimum.problem.limits, best.speed)
    steps("check against a sweep")
    swept = check_turn(optimum.problem, best.gait, ratio, best.speed)
    steps("check of the circle")
    asked = target.turn.curvature
    circle = check_circle(robot, best.gait, asked.low if asked.fixed else arc.curvature)
    return TurnAnswer(name, sha256, optimum, replayed, swept, arc=arc, circle=circle, **told)
