"""`rr-opt study STUDY`: a problem solved with many values of its keys."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps

_COLD = "Solve every case from scratch, not from its neighbours."
_RESTART = "Discard the rows of an earlier run."


def study(
    study: Annotated[Path, typer.Argument(help="Study file: a problem and what is varied.")],
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    cold: Annotated[bool, typer.Option("--cold", help=_COLD)] = False,
    restart: Annotated[bool, typer.Option("--restart", help=_RESTART)] = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Also write study.nc.")] = False,
    json: Annotated[bool, options.json_option("study.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Solve a problem for many values of its keys: limits, robot parameters, bounds.

    An interrupted run resumes when the same command is repeated.
    """
    with Steps() as steps:
        asked = rr.load_study(study)
        folder = options.study_folder(out, asked.name, netcdf=netcdf)
        given = {"workers": workers, "scheduler": scheduler, "cold": cold, "restart": restart}
        solved = rr.study(asked, folder=folder, **given, progress=steps)
        files = solved.save(folder, figures=figures, netcdf=netcdf, progress=steps)
    show(solved, files, json=json)
