"""`rr-opt lint FILES`: every problem of the input files, before anything is computed."""

from __future__ import annotations

import json as json_format
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rr_opt.outcome import EXIT_WRONG_INPUT

if TYPE_CHECKING:
    from rr_opt.files.issue import Issue


def lint(
    files: Annotated[
        list[Path],
        typer.Argument(
            help="Robot, problem, study or experiment files, or folders with a problem.yaml or an "
            "experiment.yaml, whose recordings are read too."
        ),
    ],
    json: Annotated[bool, typer.Option("--json", help="Print JSON on stdout.")] = False,
) -> None:
    """Check input files and print every problem of all of them. Exits 2 if one is an error."""
    from rr_opt.files.issue import has_errors

    checked = {str(file): _issues(file) for file in files}
    wrong = any(has_errors(issues) for issues in checked.values())
    if json:
        found = [asdict(issue) for issues in checked.values() for issue in issues]
        typer.echo(json_format.dumps({"ok": not wrong, "issues": found}, indent=2))
    else:
        for name, issues in checked.items():
            for issue in issues:
                typer.echo(str(issue))
            if not has_errors(issues):
                typer.echo(f"{name}: can be used")
    if wrong:
        raise typer.Exit(EXIT_WRONG_INPUT)


def _issues(file: Path) -> list[Issue]:
    """All of them; of an experiment also those of its recordings, and which tell nothing."""
    from rr_opt.files.lint import experiment_file, lint_file

    experiment = experiment_file(file)
    if experiment is None:
        return lint_file(file)
    from rr_opt.cli.diagnose_input import checked
    from rr_opt.files.issue import Issue
    from rr_opt.recordings.experiment import experiment_of

    read, issues = experiment_of(experiment)
    if read is not None:
        found, place = checked(read), str(experiment)
        issues += [Issue("error", "", text, file=place) for text in found.wrong]
        said = found.left_out if found.wrong else (*found.left_out, *found.said)
        issues += [Issue("warning", "", text, file=place) for text in said]
    return issues
