"""`rr-opt maximize-speed [PROBLEM]`: the fastest gait, checked, with the files that show it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from rr_opt.cli.options import (
    Figures,
    ProblemFile,
    json_option,
    out_option,
    read_problem,
    results_folder,
)
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps


def maximize_speed(
    problem: ProblemFile = None,
    out: Annotated[Path | None, out_option("out/NAME")] = None,
    json: Annotated[bool, json_option("result.json")] = False,
    figures: Figures = True,
) -> None:
    """Find the fastest gait of a problem.

    The answer is checked by a simulation and a sweep, and reported with its active limits.
    """
    with Steps() as steps:
        posed = read_problem(problem)
        folder = results_folder(out, posed.name)
        from rr_opt.api import fastest

        best = fastest.maximize_speed(posed, progress=steps)
        files = best.save(folder, figures=figures, progress=steps)
    show(best, files, json=json)
