"""`rr-opt inspect FILE`: read a recording, clean it, and list every warning."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from rr_opt.cli.options import Figures, json_option, out_option, read_options, results_folder
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps
from rr_opt.outcome import InputError

if TYPE_CHECKING:
    from rr_opt.model.gait import Gait

_SOURCE = "A recording (plain CSV, Vicon CSV, C3D, TRC or netCDF), or the folder of an experiment."
_LAYOUT = "Position of each marker; default: estimated from the recording."
_NETCDF = "Also write the recording, with its flags, as netCDF."


def inspect(
    source: Annotated[Path, typer.Argument(metavar="FILE|FOLDER", help=_SOURCE)],
    *,
    layout: Annotated[Path | None, typer.Option(metavar="YAML", help=_LAYOUT)] = None,
    servo_log: Annotated[
        Path | None, typer.Option(metavar="CSV", help="The servo's log, on its own clock.")
    ] = None,
    amplitude: Annotated[
        str | None, typer.Option(help="Commanded amplitude in rad, or with a unit.")
    ] = None,
    period: Annotated[str | None, typer.Option(help="Commanded period, s.")] = None,
    offset: Annotated[str | None, typer.Option(help="Commanded offset, rad.")] = None,
    start: Annotated[
        Literal["rest", "running"],
        typer.Option(help="Whether the robot stood still until t = 0 or was already running."),
    ] = "running",
    out: Annotated[Path | None, out_option("out/NAME-inspect")] = None,
    netcdf: Annotated[Path | None, typer.Option(metavar="FILE", help=_NETCDF)] = None,
    figures: Figures = True,
    json: Annotated[bool, json_option("inspection.json")] = False,
) -> None:
    """Read a recording, clean it, and list every warning.

    Outliers are flagged, and gaps stay gaps. Writes inspection.json and report.html.
    """
    with Steps() as steps:
        steps("reading")
        from rr_opt.api import inspect as library

        gait = _gait(read_options(amplitude=amplitude, period=period, offset=offset))
        folder = results_folder(out, f"{library.name_of(source)}-inspect")
        library.check_files(source, netcdf)
        found = library.inspect(
            source, layout=layout, servo_log=servo_log, gait=gait, start=start, progress=steps
        )
        files = found.save(folder, figures=figures, netcdf=netcdf, progress=steps)
    show(found, files, json=json)


def _gait(read: dict[str, float]) -> Gait | None:
    """The gait of the options; None if there is none."""
    if not read:
        return None
    from rr_opt.model.gait import SineGait

    if "amplitude" not in read or "period" not in read:
        raise InputError(
            "The command was given in part. Expected --amplitude and --period, and --offset unless "
            "it is 0. Give both, or neither."
        )
    return SineGait(read["amplitude"], read["period"], read.get("offset", 0.0))
