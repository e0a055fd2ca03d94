"""`rr-opt study STUDY`: a problem solved with many values of its keys."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import Figures, Scheduler, Workers, json_option, out_option, results_folder
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps


def study(
    study: Annotated[Path, typer.Argument(help="Study file: a problem and what is varied.")],
    out: Annotated[Path | None, out_option("out/NAME")] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    cold: Annotated[
        bool, typer.Option("--cold", help="Solve every case from scratch, not from its neighbours.")
    ] = False,
    restart: Annotated[
        bool, typer.Option("--restart", help="Discard the rows of an earlier run.")
    ] = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Also write study.nc.")] = False,
    json: Annotated[bool, json_option("study.json")] = False,
    figures: Figures = True,
) -> None:
    """Solve a problem for many values of its keys: limits, robot parameters, bounds.

    An interrupted run resumes when the same command is repeated.
    """
    with Steps() as steps:
        from rr_opt.api import study as library
        from rr_opt.report.study import check_files

        asked = library.load_study(study)
        check_files(netcdf=netcdf)
        folder = results_folder(out, asked.name)
        options = {"workers": workers, "scheduler": scheduler, "cold": cold, "restart": restart}
        solved = library.study(asked, folder=folder, **options, progress=steps)
        files = solved.save(folder, figures=figures, netcdf=netcdf, progress=steps)
    show(solved, files, json=json)
