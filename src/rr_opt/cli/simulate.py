"""`rr-opt simulate [FILE]`: a gait driven for some time, from rest or from the steady state."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.problem_input import place
from rr_opt.cli.steps import Steps


class Start(StrEnum):
    """How the motion begins."""

    REST = "rest"
    STEADY = "steady"


class Format(StrEnum):
    """How the trajectory is stored."""

    CSV = "csv"
    NETCDF = "netcdf"


class Film(StrEnum):
    """How the motion is shown."""

    GIF = "gif"
    MP4 = "mp4"


def simulate(
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
    seconds: Annotated[float, typer.Option(help="How long to drive, s.")] = 10.0,
    start: Annotated[
        Start, typer.Option(help="From rest, or from the speed that the gait settles to.")
    ] = Start.REST,
    rate: Annotated[float, typer.Option(help="Samples a second.")] = 100.0,
    out: Annotated[
        Path | None,
        typer.Option(
            parser=place,
            metavar="DIR",
            help="Folder for the files.",
            show_default="out/NAME-motion",
        ),
    ] = None,
    kind: Annotated[Format, typer.Option("--format", help="Trajectory file.")] = Format.CSV,
    animate: Annotated[Film | None, typer.Option(help="Also make a film.")] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print a machine-readable summary alone on stdout.")
    ] = False,
) -> None:
    """Drive a gait for some time.

    Writes the trajectory, a figure and, if asked for, a film.
    """
    with Steps() as steps:
        from rr_opt.answers.motion import MotionAnswer
        from rr_opt.cli.motion_input import read_options, read_source, result_name
        from rr_opt.motion.rollout import measured, rollout
        from rr_opt.report.archive import folder_for_results, strict_json
        from rr_opt.report.motion import check_wishes, motion_record, motion_summary, write_motion

        options = read_options(
            amplitude=amplitude, period=period, offset=offset, seconds=seconds, rate=rate
        )
        given = read_source(source, options)
        robot, gait = given.robot, given.gait
        film = animate.value if animate else None
        check_wishes(kind.value, film)
        folder = folder_for_results(out or Path("out") / f"{result_name(source)}-motion")
        steps("simulate by CVODES")
        driven = rollout(robot, gait, seconds, start.value, rate)
        steps("measure")
        reached = measured(robot, gait, driven)
        motion = MotionAnswer(robot, gait, given.status, start.value, driven, reached)
        written = write_motion(motion, folder, kind=kind.value, film=film, progress=steps)
    for warning in motion.beyond_servo:
        typer.echo(f"warning: {warning}", err=True)
    if json:
        typer.echo(strict_json(motion_record(motion, written)), nl=False)
    else:
        typer.echo(motion_summary(motion, written), nl=False)
