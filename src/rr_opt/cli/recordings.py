"""Verbs that read recordings: what looks wrong in them, and why the robot moves differently."""

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay


def inspect(
    source: options.Recorded,
    *,
    layout: options.Layout = None,
    servo_log: options.ServoLog = None,
    columns: options.Columns = None,
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
    with StepDisplay() as steps:
        steps("reading")
        gait = options.read_command(amplitude=amplitude, period=period, offset=offset)
        folder = options.inspection_folder(out, source, netcdf)
        given = {"layout": layout, "servo_log": servo_log, "gait": gait, "start": start}
        named = options.read_columns(columns)
        found = rr.inspect(source, columns=named, **given, progress=steps)
    more = {"netcdf": netcdf} if netcdf else {}
    show(found, steps, folder, json=json, figures=figures, **more)


def diagnose(
    source: Annotated[
        Path,
        typer.Argument(metavar="FOLDER", help="Folder with an experiment.yaml and its recordings."),
    ],
    out: Annotated[Path | None, options.out_option("out/NAME-diagnosis")] = None,
    json: Annotated[bool, options.json_option("diagnosis.json")] = False,
    page: Annotated[
        bool, typer.Option("--page/--no-page", help="Draw figures and write report.html.")
    ] = True,
) -> None:
    """Find out why recordings differ from the simulation.

    Says where, by which physics, and how certainly. Writes diagnosis.json, robot-corrected.yaml
    for the other verbs, and report.html.
    """
    with StepDisplay() as steps:
        steps("reading")
        experiment = rr.load_experiment(source)
        folder = options.results_folder(out, f"{experiment.name}-diagnosis")
        found = rr.diagnose(experiment, progress=steps)
    show(found, steps, folder, json=json, figures=page)
