"""`rr-opt circle [FILE]`: the circle that a gait drives, and how a start from rest comes to it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.steps import Steps


def circle(
    source: Annotated[
        Path | None,
        typer.Argument(
            metavar="[FILE]",
            help="Robot file, problem file or result.json; the paper's prototype if left out.",
        ),
    ] = None,
    *,
    amplitude: Annotated[
        str | None, typer.Option(help="Amplitude, rad, or with a unit: '30 deg'.")
    ] = None,
    period: Annotated[str | None, typer.Option(help="Period, s, or with a unit.")] = None,
    offset: Annotated[str | None, typer.Option(help="Offset, rad, or with a unit.")] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print a machine-readable record alone on stdout.")
    ] = False,
) -> None:
    """Tell the circle that a gait drives: radius, centre, speed, time for a full turn.

    With it how a start from rest comes to that circle. Left is positive, seen from above.
    """
    with Steps() as steps:
        from rr_opt.answers.motion import CircleAnswer
        from rr_opt.cli.motion_input import read_options, read_source
        from rr_opt.motion.circle import circle_of, transient
        from rr_opt.motion.dynamics import require_friction
        from rr_opt.motion.steady_cycle import require_regular, steady_cycle
        from rr_opt.report.archive import strict_json
        from rr_opt.report.turn.circle import circle_record, circle_summary

        options = read_options(amplitude=amplitude, period=period, offset=offset)
        given = read_source(source, options)
        robot, gait = given.robot, given.gait
        require_friction(robot)
        require_regular(robot, gait)
        steps("steady cycle")
        steady = steady_cycle(robot, gait)
        round_, start = circle_of(steady.cycle), transient(robot, steady)
        answer = CircleAnswer(robot, gait, given.status, round_, start)
    if json:
        typer.echo(strict_json(circle_record(answer)), nl=False)
    else:
        typer.echo(circle_summary(answer), nl=False)
