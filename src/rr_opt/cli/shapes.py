"""`rr-opt shapes [PROBLEM]`: is a sine the best wiggle?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import Figures, ProblemFile, json_option, out_option
from rr_opt.cli.problem_input import name_of, read
from rr_opt.cli.steps import Steps
from rr_opt.outcome import Status


def shapes(
    problem: ProblemFile = None,
    out: Annotated[Path | None, out_option("out/NAME-shapes")] = None,
    json: Annotated[bool, json_option("shapes.json")] = False,
    figures: Figures = True,
) -> None:
    """Compare the fastest sine with faster shapes: 3 and 5 harmonics, and a free gait.

    All keep the same limits, and each is checked. The shape that the problem asks for is ignored.
    """
    with Steps() as steps:
        steps("reading")
        posed, sha256 = read(problem)
        from rr_opt.report.archive import folder_for_results, strict_json

        name = name_of(problem)
        folder = folder_for_results(out or Path("out") / f"{name}-shapes")
        from rr_opt.answers.shapes import ShapesAnswer, family_name
        from rr_opt.answers.speed import SpeedAnswer, evidence
        from rr_opt.design.maximize_speed import compare_shapes
        from rr_opt.report.shapes import record, summary, write_shapes
        from rr_opt.verify.sweep import sweep

        optima = compare_shapes(posed, steps)
        answers, swept = [], None
        if any(one.best for one in optima):
            # One for all: it is a sweep of the sines, whatever the shape.
            steps("sweep of all sines")
            swept = sweep(posed)
        for optimum in optima:
            family = family_name(optimum.problem.gait)
            seen = evidence(optimum, steps, swept)
            answers.append(SpeedAnswer(f"{name}, {family}", sha256, optimum, *seen))
        compared = ShapesAnswer(name, sha256, tuple(answers))
        written = write_shapes(compared, folder, figures=figures, progress=steps)
    if json:
        typer.echo(strict_json(record(compared)), nl=False)
    else:
        typer.echo(summary(compared, written), nl=False)
    if compared.status is not Status.OPTIMAL:
        typer.echo(compared.message, err=True)
        raise typer.Exit(compared.status.exit_code)
