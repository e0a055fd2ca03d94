"""The verb that solves a problem, or routes, many times over."""

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay

_STUDY = "Study file: a problem and what is varied, or route files."
_COLD = "Solve every case from scratch rather than from its neighbours."
_RESTART = "Discard the rows of an earlier run."


def study(
    study: Annotated[Path, typer.Argument(help=_STUDY)],
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    cold: Annotated[bool, typer.Option("--cold", help=_COLD)] = False,
    restart: Annotated[bool, typer.Option("--restart", help=_RESTART)] = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Also write study.nc.")] = False,
    json: Annotated[bool, options.json_option("study.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Solve a problem for many values of its keys.

    Keys are limits, robot parameters and bounds. With `routes`, drives several routes instead.
    An interrupted run resumes when the same command is repeated.
    """
    given = {"workers": workers, "scheduler": scheduler, "restart": restart}
    with StepDisplay() as steps:
        if options.names_routes(study):
            routes = options.read(rr.load_routes, study)
            folder = options.results_folder(out, routes.name)
            solved = rr.routes(routes, folder=folder, **given, progress=steps)
            more = {}
        else:
            asked = rr.load_study(study)
            folder = options.study_folder(out, asked.name, netcdf=netcdf)
            solved = rr.study(asked, folder=folder, **given, cold=cold, progress=steps)
            more = {"netcdf": netcdf}
    show(solved, steps, folder, json=json, figures=figures, **more)
