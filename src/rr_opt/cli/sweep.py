"""`rr-opt sweep [PROBLEM]`: try gaits all over the bounds and keep the best, without a solver."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import ProblemFile, json_option, out_option, read_problem, results_folder
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps

Points = Annotated[
    int,
    typer.Option(
        help="Approximate number of gaits on the grid; at least two values of each quantity.",
        min=1,
        max=5_000_000,
    ),
]


def sweep(
    problem: ProblemFile = None,
    points: Points = 10_000,
    out: Annotated[Path | None, out_option("out/NAME-sweep")] = None,
    json: Annotated[bool, json_option("sweep.json")] = False,
) -> None:
    """Evaluate a grid of gaits within the bounds.

    Writes every gait, the best one and a figure. No solver is involved.
    """
    with Steps() as steps:
        posed = read_problem(problem)
        folder = results_folder(out, f"{posed.name}-sweep")
        from rr_opt.api import survey

        swept = survey.sweep(posed, points, progress=steps)
        files = swept.save(folder, progress=steps)
    show(swept, files, json=json)
