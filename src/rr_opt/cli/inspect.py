"""`rr-opt inspect FILE`: read a recording, clean it, and list every warning."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import rr_opt as rr
from rr_opt.cli import choices, options
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps


def inspect(
    source: choices.Recorded,
    *,
    layout: choices.Layout = None,
    servo_log: choices.ServoLog = None,
    amplitude: choices.CommandedAmplitude = None,
    period: choices.CommandedPeriod = None,
    offset: choices.CommandedOffset = None,
    start: choices.Start = "running",
    out: Annotated[Path | None, options.out_option("out/NAME-inspect")] = None,
    netcdf: choices.NetCDF = None,
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
