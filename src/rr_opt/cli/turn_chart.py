"""`rr-opt turn-chart [PROBLEM]`: the circles of a robot, and the tightest it can make."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rr_opt.cli.options import ProblemFile, json_option, out_option
from rr_opt.cli.problem_input import name_of, read
from rr_opt.cli.steps import Steps
from rr_opt.outcome import Status

_DRAWN = (6, 4, 121)
"""Amplitudes, periods and offsets of the chart."""
_HELD = (24, 10, 101)
"""The same of the map against which the paper's claim is held."""


def turn_chart(
    problem: ProblemFile = None,
    out: Annotated[Path | None, out_option("out/NAME-turn-chart")] = None,
    json: Annotated[bool, json_option("turn-chart.json")] = False,
) -> None:
    """Chart the circles of a robot: radius over offset, amplitude and period.

    Finds the tightest circle within the limits, and tells where the offset alone does not decide
    on the circle. The inertia ratio is that of the robot as it is.
    """
    with Steps() as steps:
        steps("reading")
        posed, sha256 = read(problem)
        from rr_opt.answers.turn_chart import TurnChartAnswer
        from rr_opt.motion.dynamics import require_friction
        from rr_opt.report.archive import folder_for_results, strict_json
        from rr_opt.report.turn.chart import chart_record, chart_summary, write_chart
        from rr_opt.verify.turn.chart import tightest, turn_map
        from rr_opt.verify.turn.offset_claim import radius_claim, sign_claim

        require_friction(posed.robot)
        name = name_of(problem)
        folder = folder_for_results(out or Path("out") / f"{name}-turn-chart")
        steps("chart")
        seen = turn_map(posed, _DRAWN)
        steps("the paper's claim")
        fine = turn_map(posed, _HELD)
        steps("tightest circle")
        tight = tightest(posed)
        claims = sign_claim(fine), radius_claim(fine)
        chart = TurnChartAnswer(name, sha256, posed, seen, tight, *claims)
        steps("files")
        written = write_chart(chart, folder)
    if not seen.two_sided:
        typer.echo(
            "warning: The robot's two sides differ. The chart is of offsets of 0 and more alone.",
            err=True,
        )
    if json:
        typer.echo(strict_json(chart_record(chart)), nl=False)
    else:
        typer.echo(chart_summary(chart, written), nl=False)
    if chart.status is Status.INFEASIBLE:
        typer.echo(chart.message, err=True)
        raise typer.Exit(chart.status.exit_code)
