"""`rr-opt shapes [PROBLEM]`: is a sine the best waveform?"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def shapes(
    problem: options.ProblemFile = None,
    out: Annotated[Path | None, options.out_option("out/NAME-shapes")] = None,
    json: Annotated[bool, options.json_option("shapes.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Compare the fastest sine with other waveforms: 3 and 5 harmonics, and a free gait.

    All satisfy the same limits, and each is checked. The problem's own shape is ignored.
    """
    with Steps() as steps:
        posed = options.read_problem(problem)
        folder = options.results_folder(out, f"{posed.name}-shapes")
        compared = rr.shapes(posed, progress=steps)
        files = compared.save(folder, figures=figures, progress=steps)
    show(compared, files, json=json)
