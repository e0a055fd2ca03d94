"""`rr-opt diagnose FOLDER`: where the simulation goes wrong, what it leaves out, and how sure."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


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
    """Find out why recordings differ from the simulation: where, by which physics, and how sure.

    Writes diagnosis.json, robot-corrected.yaml for the other verbs, and report.html.
    """
    with Steps() as steps:
        steps("reading")
        experiment = rr.load_experiment(source)
        folder = options.results_folder(out, f"{experiment.name}-diagnosis")
        found = rr.diagnose(experiment, progress=steps)
        files = found.save(folder, figures=page, progress=steps)
    show(found, files, json=json)
