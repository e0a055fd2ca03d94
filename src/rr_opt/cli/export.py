"""`rr-opt export [FILE]`: a gait as set points for a controller, and what they cost in speed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps

_FORMAT = (
    "csv: time and angle in rad and degrees; c-header: a C array; "
    "servo: counts of the servo CDS5516."
)
_KEEP = "Adjust the rate instead of the period."
Format = Annotated[Literal["csv", "c-header", "servo"], typer.Option("--format", help=_FORMAT)]


def export(
    source: options.Driven = None,
    *,
    kind: Format = "csv",
    rate: Annotated[float, typer.Option(help="Set points per second.")] = 125.0,
    keep_period: Annotated[bool, typer.Option("--keep-period", help=_KEEP)] = False,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    out: Annotated[
        Path | None, options.out_option("out/NAME-...", "The file to write.", "FILE")
    ] = None,
    json: options.Summary = False,
) -> None:
    """Write a gait as set points for a controller.

    A period holds a whole number of set points. The loss of speed is reported separately for
    the adjusted period, the straight lines between set points, and rounding to counts.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        driven = options.read_gait(source, options.read_options(**gait, rate=rate))
        file = options.setpoints_file(out, source, kind)
        points = rr.export(driven, format=kind, rate=rate, keep_period=keep_period, progress=steps)
        files = points.save(file)
    show(points, files, json=json)
