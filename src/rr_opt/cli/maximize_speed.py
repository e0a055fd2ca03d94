"""`rr-opt maximize-speed [PROBLEM]`: the fastest gait, checked, with the files that show it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def maximize_speed(
    problem: options.ProblemFile = None,
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    json: Annotated[bool, options.json_option("result.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Find the fastest gait of a problem.

    The answer is checked by a simulation and a sweep, and reported with its active limits.
    """
    with Steps() as steps:
        posed = options.read_problem(problem)
        folder = options.results_folder(out, posed.name)
        best = rr.maximize_speed(posed, progress=steps)
        files = best.save(folder, figures=figures, progress=steps)
    show(best, files, json=json)
