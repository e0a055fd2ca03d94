"""Reading the input of a verb: its name, and its warnings on stderr."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from rr_opt.cli.passed_over import tell_passed_over

if TYPE_CHECKING:
    from rr_opt.problem import Problem


def read(path: Path | None) -> tuple[Problem, str]:
    """The problem of a file (None: the shipped one), and its fingerprint."""
    from rr_opt.files import input_sha256, lint_file, read_problem  # noqa: PLC0415

    problem = read_problem(path)
    if path is not None:
        for issue in lint_file(path):
            typer.echo(str(issue), err=True)
    tell_passed_over(problem.robot)
    return problem, input_sha256(path)


def name_of(path: Path | None) -> str:
    """What a problem is called: its folder if the file is a problem.yaml, else the file."""
    if path is None:
        return "prototype"
    full = path.resolve()
    return full.parent.name if full.name == "problem.yaml" else full.stem
