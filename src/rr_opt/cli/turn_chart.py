"""`rr-opt turn-chart [PROBLEM]`: the circles of a robot, and the tightest it can make."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def turn_chart(
    problem: options.ProblemFile = None,
    out: Annotated[Path | None, options.out_option("out/NAME-turn-chart")] = None,
    json: Annotated[bool, options.json_option("turn-chart.json")] = False,
) -> None:
    """Chart the circles of a robot: radius over offset, amplitude and period.

    Finds the tightest circle within the limits, and reports where the offset alone does not
    determine the circle. The inertia ratio is the robot's own.
    """
    with Steps() as steps:
        posed = options.read_problem(problem)
        folder = options.results_folder(out, f"{posed.name}-turn-chart")
        chart = rr.turn_chart(posed, progress=steps)
        files = chart.save(folder, progress=steps)
    show(chart, files, json=json)
