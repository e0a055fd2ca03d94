"""`rr-opt simulate [FILE]`: a gait driven for some time, from rest or from the steady state."""

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
    results_folder,
)
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps

_START = "From rest, or from the steady state."
Film = Annotated[Literal["gif", "mp4"] | None, typer.Option(help="Also make an animation.")]
Format = Annotated[Literal["csv", "netcdf"], typer.Option("--format", help="Trajectory file.")]


def simulate(
    source: Driven = None,
    *,
    amplitude: Amplitude = None,
    period: Period = None,
    offset: Offset = None,
    seconds: Annotated[float, typer.Option(help="Simulated time, s.")] = 10.0,
    start: Annotated[Literal["rest", "steady"], typer.Option(help=_START)] = "rest",
    rate: Annotated[float, typer.Option(help="Samples per second.")] = 100.0,
    out: Annotated[Path | None, out_option("out/NAME-motion", "Folder for the files.")] = None,
    kind: Format = "csv",
    animate: Film = None,
    json: Summary = False,
) -> None:
    """Simulate a gait for some time.

    Writes the trajectory, a figure and, on request, an animation.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        driven = read_gait(source, read_options(**gait, seconds=seconds, rate=rate))
        folder = results_folder(out, f"{result_name(source)}-motion")
        from rr_opt.api import drive
        from rr_opt.report.motion import check_files

        check_files(kind, animate)
        motion = drive.simulate(driven, None, seconds, start=start, rate=rate, progress=steps)
        files = motion.save(folder, format=kind, film=animate, progress=steps)
    show(motion, files, json=json)
