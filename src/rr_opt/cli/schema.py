"""`rr-opt schema KIND`: the JSON Schema of an input file, for editors."""

from __future__ import annotations

import json
from typing import Annotated

import typer

import rr_opt as rr


def schema(
    kind: Annotated[
        str, typer.Argument(help="Which file: robot, problem, study, experiment or route.")
    ],
) -> None:
    """Print the JSON Schema of an input file, with which editors complete and check it."""
    typer.echo(json.dumps(rr.schema(kind), indent=2))
