"""Arguments and options that verbs have in common."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rr_opt.cli.problem_input import place

ProblemFile = Annotated[
    Path | None,
    typer.Argument(
        help="Problem file, its folder, or a robot file; the paper's prototype if left out."
    ),
]
Figures = Annotated[
    bool, typer.Option("--figures/--no-figures", help="Draw figures and write report.html.")
]


def out_option(shown: str) -> Any:
    """--out; shown: what it is if left out."""
    return typer.Option(
        parser=place, metavar="DIR", help="Folder for the results.", show_default=shown
    )


def json_option(file: str) -> Any:
    """--json, which prints what the file holds."""
    return typer.Option("--json", help=f"Print {file} alone on stdout.")
