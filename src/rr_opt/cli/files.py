"""Verbs about input files: new ones, what is wrong in them, and their schemas."""

import json
import json as json_format
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Literal

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.outcome import EXIT_WRONG_INPUT

_KIND = "robot, problem, study, experiment or route."
_OUT = "The file to write; for an experiment, its folder."


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


_FILES = (
    "Robot, problem, study, route or experiment files, or folders with a problem.yaml or an "
    "experiment.yaml, whose recordings are read too."
)


def lint(
    files: Annotated[list[Path], typer.Argument(help=_FILES)],
    json: Annotated[bool, typer.Option("--json", help="Print JSON on stdout.")] = False,
) -> None:
    """Check input files and list every mistake in them. Exits with 2 if there is an error."""
    from rr_opt.api import files as library
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


def schema(
    kind: Annotated[str, typer.Argument(help=f"Kind of file: {_KIND}")],
    machine: Annotated[
        str, typer.Option(help="For an experiment: racer, pendulum, servo or car.")
    ] = "racer",
) -> None:
    """Print the JSON Schema of an input file. Editors complete and check files with it."""
    typer.echo(json.dumps(rr.schema(kind, machine), indent=2))
