"""`rr-opt reproduce`: the paper's tables and figures recomputed, and its statements checked."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import Figures, json_option, out_option
from rr_opt.cli.steps import Steps


def reproduce(
    out: Annotated[Path | None, out_option("out/paper")] = None,
    json: Annotated[bool, json_option("reproduce.json")] = False,
    figures: Figures = True,
) -> None:
    """Recompute the paper's tables and figures, and check its statements.

    Takes about a minute. The robot is the shipped prototype.
    """
    with Steps() as steps:
        steps("reading")
        from rr_opt.api.load import shipped
        from rr_opt.report.archive import folder_for_results, strict_json

        problem = shipped()
        folder = folder_for_results(out or Path("out") / "paper")
        from rr_opt.report.text import terminal
        from rr_paper.report.reproduction import document, record, write_reproduction
        from rr_paper.reproduction import reproduce as compute

        found = compute(problem, steps)
        steps("files")
        written = write_reproduction(found, problem.sha256, folder, figures=figures)
    if found.mujoco is None:
        typer.echo(
            "MuJoCo is not installed, so it could not be used as a further check of the signs of "
            "equation (3). Install it with `pip install 'rr-opt[lab]'`.",
            err=True,
        )
    if json:
        typer.echo(strict_json(record(found, problem.sha256)), nl=False)
    else:
        typer.echo(terminal(document(found, problem.sha256, {}), written), nl=False)
