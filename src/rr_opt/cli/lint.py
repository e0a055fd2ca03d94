"""`rr-opt lint FILES`: every problem of the input files, before anything is computed."""

from __future__ import annotations

import json as json_format
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from rr_opt.outcome import EXIT_WRONG_INPUT

_FILES = (
    "Robot, problem, study, route or experiment files, or folders with a problem.yaml or an "
    "experiment.yaml, whose recordings are read too."
)


def lint(
    files: Annotated[list[Path], typer.Argument(help=_FILES)],
    json: Annotated[bool, typer.Option("--json", help="Print JSON on stdout.")] = False,
) -> None:
    """Check input files and list every mistake in them. Exits with 2 if there is an error."""
    from rr_opt.api import lint as library
    from rr_opt.files.issue import has_errors

    checked = {str(file): library.lint(file) for file in files}
    wrong = any(has_errors(issues) for issues in checked.values())
    if json:
        found = [asdict(issue) for issues in checked.values() for issue in issues]
        typer.echo(json_format.dumps({"ok": not wrong, "issues": found}, indent=2))
    else:
        for name, issues in checked.items():
            for issue in issues:
                typer.echo(str(issue))
            if not has_errors(issues):
                typer.echo(f"{name}: OK")
    if wrong:
        raise typer.Exit(EXIT_WRONG_INPUT)
