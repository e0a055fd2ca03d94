"""`rr-opt sweep [PROBLEM]`: try gaits all over the bounds and keep the best, without a solver."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import ProblemFile, json_option, out_option
from rr_opt.cli.problem_input import name_of, read
from rr_opt.cli.steps import Steps
from rr_opt.outcome import Status


def sweep(
    problem: ProblemFile = None,
    points: Annotated[
        int,
        typer.Option(
            help="About so many gaits on the grid, and at least two values of each quantity.",
            min=1,
            max=5_000_000,
        ),
    ] = 10_000,
    out: Annotated[Path | None, out_option("out/NAME-sweep")] = None,
    json: Annotated[bool, json_option("sweep.json")] = False,
) -> None:
    """Try gaits all over the bounds.

    Writes all of them, the best one, and a figure; no solver is involved.
    """
    with Steps() as steps:
        steps("reading")
        posed, sha256 = read(problem)
        from rr_opt.answers.sweep import SweepAnswer
        from rr_opt.motion.dynamics import require_friction
        from rr_opt.report.archive import folder_for_results, strict_json
        from rr_opt.report.swept import record, summary, values_per_decision, write_sweep
        from rr_opt.verify.sweep import sweep as try_all

        require_friction(posed.robot)
        name = name_of(problem)
        folder = folder_for_results(out or Path("out") / f"{name}-sweep")
        counts = values_per_decision(posed, points)
        tried = try_all(posed, counts, lambda done, of: steps(f"gait {done} of {of}"))
        swept = SweepAnswer(name, sha256, posed, tried)
        steps("files")
        written = write_sweep(swept, folder)
    if json:
        typer.echo(strict_json(record(swept)), nl=False)
    else:
        typer.echo(summary(swept, written), nl=False)
    if swept.status is Status.INFEASIBLE:
        typer.echo(swept.message, err=True)
        raise typer.Exit(swept.status.exit_code)
