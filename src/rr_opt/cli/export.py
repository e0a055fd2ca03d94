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
    "csv: time and angle in rad and degrees; c-header: a C array; "
    "servo: counts of the servo CDS5516."
)
_KEEP = "Adjust the rate instead of the period."


def export(
    source: Driven = None,
    *,
    kind: Annotated[
        Literal["csv", "c-header", "servo"], typer.Option("--format", help=_FORMAT)
    ] = "csv",
    rate: Annotated[float, typer.Option(help="Set points per second.")] = 125.0,
    keep_period: Annotated[bool, typer.Option("--keep-period", help=_KEEP)] = False,
    amplitude: Amplitude = None,
    period: Period = None,
    offset: Offset = None,
    out: Annotated[Path | None, out_option("out/NAME-...", "The file to write.", "FILE")] = None,
    json: Summary = False,
) -> None:
    """Write a gait as set points for a controller.

    A period holds a whole number of set points. The loss of speed is reported separately for
    the adjusted period, the straight lines between set points, and rounding to counts.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        driven = read_gait(source, read_options(**gait, rate=rate))
        from rr_opt.api import drive
        from rr_opt.results.setpoints import setpoints_file

        file = setpoints_file(out, result_name(source), kind)
        points = drive.export(
            driven, format=kind, rate=rate, keep_period=keep_period, progress=steps
        )
        files = points.save(file)
    show(points, files, json=json)
