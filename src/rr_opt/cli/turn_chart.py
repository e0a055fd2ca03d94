"""`rr-opt turn-chart [PROBLEM]`: the circles of a robot, and the tightest it can make."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from rr_opt.cli.options import ProblemFile, json_option, out_option, read_problem, results_folder
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps


def turn_chart(
    problem: ProblemFile = None,
    out: Annotated[Path | None, out_option("out/NAME-turn-chart")] = None,
    json: Annotated[bool, json_option("turn-chart.json")] = False,
) -> None:
    """Chart the circles of a robot: radius over offset, amplitude and period.

    Finds the tightest circle within the limits, and reports where the offset alone does not
    determine the circle. The inertia ratio is the robot's own.
    """
    with Steps() as steps:
        posed = read_problem(problem)
        folder = results_folder(out, f"{posed.name}-turn-chart")
        from rr_opt.api import survey

        chart = survey.turn_chart(posed, progress=steps)
        files = chart.save(folder, progress=steps)
    show(chart, files, json=json)
