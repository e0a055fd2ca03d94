"""`rr-opt schema KIND`: the JSON Schema of an input file, for editors."""

from __future__ import annotations

import json
from typing import Annotated

import typer

from rr_opt.outcome import InputError


def schema(
    kind: Annotated[str, typer.Argument(help="Which file: robot, problem, study or experiment.")],
) -> None:
    """Print the JSON Schema of an input file, with which editors complete and check it."""
    from rr_opt.files.schemas import schema as json_schema

    try:
        found = json_schema(kind)
    except InputError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(error.exit_code) from None
    typer.echo(json.dumps(found, indent=2))
