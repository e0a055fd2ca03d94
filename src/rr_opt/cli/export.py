"""`rr-opt export [FILE]`: a gait as set points for a controller, and what they cost in speed."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.problem_input import place
from rr_opt.cli.steps import Steps


class Format(StrEnum):
    """How the set points are written."""

    CSV = "csv"
    C_HEADER = "c-header"
    SERVO = "servo"


def export(
    source: Annotated[
        Path | None,
        typer.Argument(
            metavar="[FILE]",
            help="A result.json, a robot or a problem; the paper's prototype if left out.",
        ),
    ] = None,
    *,
    kind: Annotated[
        Format,
        typer.Option(
            "--format",
            help="csv: time and angle in rad and degrees; c-header: an array for C; "
            "servo: counts of the servo CDS5516.",
        ),
    ] = Format.CSV,
    rate: Annotated[float, typer.Option(help="Set points a second.")] = 125.0,
    keep_period: Annotated[
        bool,
        typer.Option("--keep-period", help="Change the rate and not the period to fit them in."),
    ] = False,
    amplitude: Annotated[
        str | None, typer.Option(help="Amplitude, rad, or with a unit: '30 deg'.")
    ] = None,
    period: Annotated[str | None, typer.Option(help="Period, s, or with a unit.")] = None,
    offset: Annotated[str | None, typer.Option(help="Offset, rad, or with a unit.")] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            parser=place, metavar="FILE", help="The file to write.", show_default="out/NAME-..."
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print a machine-readable summary alone on stdout.")
    ] = False,
) -> None:
    """Write a gait as set points for a controller.

    A period holds a whole number of set points. What that, moving from one to the next, and
    rounding to the servo's counts cost in speed is told each by itself.
    """
    with Steps() as steps:
        from rr_opt.answers.motion import SetPointsAnswer
        from rr_opt.cli.motion_input import read_options, read_source, result_name
        from rr_opt.motion.setpoints import cost, set_points
        from rr_opt.report.archive import file_for_result, strict_json, write_text
        from rr_opt.report.setpoints import ENDINGS, setpoints_record, setpoints_summary, text_of

        options = read_options(amplitude=amplitude, period=period, offset=offset, rate=rate)
        given = read_source(source, options)
        name = f"{result_name(source)}{ENDINGS[kind.value]}"
        file = file_for_result(out or Path("out") / name)
        points = set_points(given.gait, rate, keep_period=keep_period)
        text = text_of(points, kind.value)
        steps("what the set points cost")
        rounded = kind is Format.SERVO
        lost = cost(given.robot, points, rounded=rounded)
        answer = SetPointsAnswer(given.robot, given.gait, given.status, points, lost, kind.value)
        write_text(file, text)
    for warning in answer.beyond_servo:
        typer.echo(f"warning: {warning}", err=True)
    if json:
        typer.echo(strict_json(setpoints_record(answer, file)), nl=False)
    else:
        typer.echo(setpoints_summary(answer, file), nl=False)
