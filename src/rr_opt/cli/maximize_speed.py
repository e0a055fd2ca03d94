"""`rr-opt maximize-speed [PROBLEM]`: the fastest gait, checked, with the files that show it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import Figures, ProblemFile, json_option, out_option
from rr_opt.cli.problem_input import name_of, read
from rr_opt.cli.steps import Steps
from rr_opt.outcome import Status


def maximize_speed(
    problem: ProblemFile = None,
    out: Annotated[Path | None, out_option("out/NAME")] = None,
    json: Annotated[bool, json_option("result.json")] = False,
    figures: Figures = True,
) -> None:
    """Find the fastest gait of a problem.

    It is checked by simulation and against a plain sweep, and told with the limits that hold it.
    """
    with Steps() as steps:
        steps("reading")
        posed, sha256 = read(problem)
        from rr_opt.answers.speed import SpeedAnswer, evidence
        from rr_opt.design.maximize_speed import maximize_speed as solve
        from rr_opt.report.archive import folder_for_results, strict_json

        name = name_of(problem)
        folder = folder_for_results(out or Path("out") / name)
        optimum = solve(posed, steps)
        answer = SpeedAnswer(name, sha256, optimum, *evidence(optimum, steps))
        from rr_opt.report.files import write_results
        from rr_opt.report.result import result
        from rr_opt.report.summary import summary

        written = write_results(answer, folder, figures=figures, progress=steps)
    if json:
        typer.echo(strict_json(result(answer)), nl=False)
    else:
        typer.echo(summary(answer, written), nl=False)
    if answer.status is not Status.OPTIMAL:
        typer.echo(answer.message, err=True)
        raise typer.Exit(answer.status.exit_code)
