"""`rr-opt simulate [FILE]`: a gait driven for some time, from rest or from the steady state."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps

_START = "From rest, or from the steady state."
Film = Annotated[Literal["gif", "mp4"] | None, typer.Option(help="Also make an animation.")]
Format = Annotated[Literal["csv", "netcdf"], typer.Option("--format", help="Trajectory file.")]


def simulate(
    source: options.Driven = None,
    *,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    seconds: Annotated[float, typer.Option(help="Simulated time, s.")] = 10.0,
    start: Annotated[Literal["rest", "steady"], typer.Option(help=_START)] = "rest",
    rate: Annotated[float, typer.Option(help="Samples per second.")] = 100.0,
    out: Annotated[
        Path | None, options.out_option("out/NAME-motion", "Folder for the files.")
    ] = None,
    kind: Format = "csv",
    animate: Film = None,
    json: options.Summary = False,
) -> None:
    """Simulate a gait for some time.

    Writes the trajectory, a figure and, on request, an animation.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        given = options.read_options(**gait, seconds=seconds, rate=rate)
        driven = options.read_gait(source, given)
        folder = options.motion_folder(out, source, kind, animate)
        motion = rr.simulate(driven, None, seconds, start=start, rate=rate, progress=steps)
        files = motion.save(folder, format=kind, film=animate, progress=steps)
    show(motion, files, json=json)
