"""`rr-opt init [KIND]`: a commented input file to begin with."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from rr_opt.cli.options import out_option

_KIND = "robot, problem, study or experiment."


def init(
    kind: Annotated[
        Literal["robot", "problem", "study", "experiment"], typer.Argument(help=_KIND)
    ] = "problem",
    out: Annotated[
        Path | None, out_option("KIND.yaml", "The file to write; of an experiment its folder.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Write over what is there.")] = False,
) -> None:
    """Write a commented input file with units, to be filled in.

    An experiment is a folder with simulated recordings, which `rr-opt diagnose` reads as they are.
    """
    from rr_opt.api.template import init as write

    for file in write(kind, out, force=force):
        typer.echo(str(file))
