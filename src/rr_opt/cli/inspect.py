"""`rr-opt inspect FILE`: read a recording, clean it, and list every warning."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def inspect(
    source: options.Recorded,
    *,
    layout: options.Layout = None,
    servo_log: options.ServoLog = None,
    amplitude: options.CommandedAmplitude = None,
    period: options.CommandedPeriod = None,
    offset: options.CommandedOffset = None,
    start: options.Start = "running",
    out: Annotated[Path | None, options.out_option("out/NAME-inspect")] = None,
    netcdf: options.NetCDF = None,
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
