"""`rr-opt inspect FILE`: read a recording, clean it, and list every warning."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps

_SOURCE = "A recording (plain CSV, Vicon CSV, C3D, TRC or netCDF), or the folder of an experiment."
_LAYOUT = "Position of each marker; default: estimated from the recording."
_LOG = "The servo's log, on its own clock."
_AMPLITUDE = "Commanded amplitude in rad, or with a unit."
_START = "Whether the robot stood still until t = 0 or was already running."
_NETCDF = "Also write the recording, with its flags, as netCDF."


def inspect(
    source: Annotated[Path, typer.Argument(metavar="FILE|FOLDER", help=_SOURCE)],
    *,
    layout: Annotated[Path | None, typer.Option(metavar="YAML", help=_LAYOUT)] = None,
    servo_log: Annotated[Path | None, typer.Option(metavar="CSV", help=_LOG)] = None,
    amplitude: Annotated[str | None, typer.Option(help=_AMPLITUDE)] = None,
    period: Annotated[str | None, typer.Option(help="Commanded period, s.")] = None,
    offset: Annotated[str | None, typer.Option(help="Commanded offset, rad.")] = None,
    start: Annotated[Literal["rest", "running"], typer.Option(help=_START)] = "running",
    out: Annotated[Path | None, options.out_option("out/NAME-inspect")] = None,
    netcdf: Annotated[Path | None, typer.Option(metavar="FILE", help=_NETCDF)] = None,
    figures: options.Figures = True,
    json: Annotated[bool, options.json_option("inspection.json")] = False,
) -> None:
    """Read a recording, clean it, and list every warning.

    Outliers are flagged, and gaps stay gaps. Writes inspection.json and report.html.
    """
    with Steps() as steps:
        steps("reading")
        gait = options.read_command(amplitude=amplitude, period=period, offset=offset)
        folder = options.inspection_folder(out, source, netcdf)
        given = {"layout": layout, "servo_log": servo_log, "gait": gait, "start": start}
        found = rr.inspect(source, **given, progress=steps)
        files = found.save(folder, figures=figures, netcdf=netcdf, progress=steps)
    show(found, files, json=json)
