"""`rr-opt export [FILE]`: a gait as set points for a controller, and what they cost in speed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from rr_opt.cli.options import (
    Amplitude,
    Driven,
    Offset,
    Period,
    Summary,
    out_option,
    read_gait,
    read_options,
    result_name,
)
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps

_FORMAT = (
    "csv: time and angle in rad and degrees; c-header: an array for C; "
    "servo: counts of the servo CDS5516."
)
_KEEP = "Change the rate and not the period to fit them in."


def export(
    source: Driven = None,
    *,
    kind: Annotated[
        Literal["csv", "c-header", "servo"], typer.Option("--format", help=_FORMAT)
    ] = "csv",
    rate: Annotated[float, typer.Option(help="Set points a second.")] = 125.0,
    keep_period: Annotated[bool, typer.Option("--keep-period", help=_KEEP)] = False,
    amplitude: Amplitude = None,
    period: Period = None,
    offset: Offset = None,
    out: Annotated[Path | None, out_option("out/NAME-...", "The file to write.", "FILE")] = None,
    json: Summary = False,
) -> None:
    """Write a gait as set points for a controller.

    A period holds a whole number of set points. What that, moving from one to the next, and
    rounding to the servo's counts cost in speed is told each by itself.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        driven = read_gait(source, read_options(**gait, rate=rate))
        from rr_opt.api import drive

        file = drive.setpoints_file(out, result_name(source), kind)
        points = drive.export(
            driven, format=kind, rate=rate, keep_period=keep_period, progress=steps
        )
        files = points.save(file)
    show(points, files, json=json)
