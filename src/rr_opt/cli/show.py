"""How every verb ends: warnings, the result on stdout, and the exit code."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from rr_opt.cli.options import warn
from rr_opt.outcome import Status

if TYPE_CHECKING:
    from rr_opt.results.result import Result


def show(result: Result, files: Sequence[Path] = (), *, json: bool) -> None:
    """Print a result and its warnings. Ends the command if it is not what was asked for."""
    from rr_opt.documents.archive import strict_json

    warn(result.warnings)
    text = strict_json(result.record(files)) if json else result.summary(files)
    typer.echo(text, nl=False)
    if result.status is not Status.OPTIMAL:
        typer.echo(result.message, err=True)
        raise typer.Exit(result.status.exit_code)
