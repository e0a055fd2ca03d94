"""`rr-opt init [KIND]`: a commented input file to begin with."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

import rr_opt as rr
from rr_opt.cli import options

_KIND = "robot, problem, study, experiment or route."
_OUT = "The file to write; of an experiment its folder."


def init(
    kind: Annotated[
        Literal["robot", "problem", "study", "experiment", "route"], typer.Argument(help=_KIND)
    ] = "problem",
    out: Annotated[Path | None, options.out_option("KIND.yaml", _OUT)] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite existing files.")] = False,
) -> None:
    """Write a commented input file with units, to be filled in.

    An experiment is a folder with simulated recordings, which `rr-opt diagnose` reads as they are.
    """
    for file in rr.init(kind, out, force=force):
        typer.echo(str(file))
