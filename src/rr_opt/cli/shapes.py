"""`rr-opt shapes [PROBLEM]`: is a sine the best waveform?"""

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


def shapes(
    problem: ProblemFile = None,
    out: Annotated[Path | None, out_option("out/NAME-shapes")] = None,
    json: Annotated[bool, json_option("shapes.json")] = False,
    figures: Figures = True,
) -> None:
    """Compare the fastest sine with other waveforms: 3 and 5 harmonics, and a free gait.

    All satisfy the same limits, and each is checked. The problem's own shape is ignored.
    """
    with Steps() as steps:
        posed = read_problem(problem)
        folder = results_folder(out, f"{posed.name}-shapes")
        from rr_opt.api import fastest

        compared = fastest.shapes(posed, progress=steps)
        files = compared.save(folder, figures=figures, progress=steps)
    show(compared, files, json=json)
