"""Options of a single verb, with their help."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from rr_opt.cli.options import out_option

Radius = Annotated[
    str | None,
    typer.Option(help="Radius of the circle in m, or with a unit; positive to the left."),
]
Heading = Annotated[
    str | None,
    typer.Option(help="Change of heading in rad, or with a unit: '90 deg'; positive to the left."),
]
Within = Annotated[str | None, typer.Option(help="Longest time for the change of heading, s.")]
Length = Annotated[str | None, typer.Option(help="Longest path for the change of heading, m.")]
Cycles = Annotated[
    Literal["any", "whole"],
    typer.Option(help="whole: the change of heading takes a whole number of periods."),
]

SetPoints = Annotated[
    Literal["csv", "c-header", "servo"],
    typer.Option(
        "--format",
        help="csv: time and angle in rad and degrees; c-header: a C array; "
        "servo: counts of the servo CDS5516.",
    ),
]
KeepPeriod = Annotated[
    bool, typer.Option("--keep-period", help="Adjust the rate instead of the period.")
]

Trajectory = Annotated[Literal["csv", "netcdf"], typer.Option("--format", help="Trajectory file.")]
Film = Annotated[Literal["gif", "mp4"] | None, typer.Option(help="Also make an animation.")]
From = Annotated[
    Literal["rest", "steady"], typer.Option(help="From rest, or from the steady state.")
]

Seconds = Annotated[float, typer.Option(help="Simulated time, s.")]
Samples = Annotated[float, typer.Option(help="Samples per second.")]
PointRate = Annotated[float, typer.Option(help="Set points per second.")]
PointFile = Annotated[Path | None, out_option("out/NAME-...", "The file to write.", "FILE")]
MotionFolder = Annotated[Path | None, out_option("out/NAME-motion", "Folder for the files.")]

Recorded = Annotated[
    Path,
    typer.Argument(
        metavar="FILE|FOLDER",
        help="A recording (plain CSV, Vicon CSV, C3D, TRC or netCDF), or the folder of an "
        "experiment.",
    ),
]
Layout = Annotated[
    Path | None,
    typer.Option(
        metavar="YAML", help="Position of each marker; default: estimated from the recording."
    ),
]
ServoLog = Annotated[
    Path | None, typer.Option(metavar="CSV", help="The servo's log, on its own clock.")
]
CommandedAmplitude = Annotated[
    str | None, typer.Option(help="Commanded amplitude in rad, or with a unit.")
]
CommandedPeriod = Annotated[str | None, typer.Option(help="Commanded period, s.")]
CommandedOffset = Annotated[str | None, typer.Option(help="Commanded offset, rad.")]
Start = Annotated[
    Literal["rest", "running"],
    typer.Option(help="Whether the robot stood still until t = 0 or was already running."),
]
NetCDF = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Also write the recording, with its flags, as netCDF."),
]
