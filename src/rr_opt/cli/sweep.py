"""`rr-opt sweep [PROBLEM]`: try gaits all over the bounds and keep the best, without a solver."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps

_POINTS = "Approximate number of gaits on the grid; at least two values of each quantity."


def sweep(
    problem: options.ProblemFile = None,
    points: Annotated[int, typer.Option(help=_POINTS, min=1, max=5_000_000)] = 10_000,
    out: Annotated[Path | None, options.out_option("out/NAME-sweep")] = None,
    json: Annotated[bool, options.json_option("sweep.json")] = False,
) -> None:
    """Evaluate a grid of gaits within the bounds.

    Writes every gait, the best one and a figure. No solver is involved.
    """
    with Steps() as steps:
        posed = options.read_problem(problem)
        folder = options.results_folder(out, f"{posed.name}-sweep")
        swept = rr.sweep(posed, points, progress=steps)
        files = swept.save(folder, progress=steps)
    show(swept, files, json=json)
