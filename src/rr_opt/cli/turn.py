"""Verbs about turns: the fastest gait of one, and what a robot can turn."""

from pathlib import Path
from typing import Annotated

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay


def turn(
    problem: options.ProblemFile = None,
    *,
    radius: options.Radius = None,
    heading: options.Heading = None,
    within: options.Within = None,
    length: options.Length = None,
    cycles: options.Cycles = "any",
    out: Annotated[Path | None, options.out_option("out/NAME-turn-...")] = None,
    force: options.Force = False,
    json: Annotated[bool, options.json_option("result.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Find the fastest gait for a turn.

    Give --radius; or --heading with --radius, --within or --length. Left is positive, seen from
    above, in either direction of travel. The problem sets the direction of travel.
    """
    with StepDisplay() as steps:
        asked = options.read_options(radius=radius, heading=heading, within=within, length=length)
        posed = options.read_problem(problem)
        folder = options.turn_folder(out, posed.name, asked, cycles, force=force)
        turned = rr.turn(posed, **asked, whole=cycles == "whole", progress=steps)
    show(turned, steps, folder, json=json, figures=figures)


def turn_chart(
    problem: options.ProblemFile = None,
    out: Annotated[Path | None, options.out_option("out/NAME-turn-chart")] = None,
    json: Annotated[bool, options.json_option("turn-chart.json")] = False,
) -> None:
    """Chart turning radius over offset, amplitude and period.

    Finds the tightest circle within the limits, and reports where the offset alone does not
    determine the circle. The inertia ratio is the robot's own.
    """
    with StepDisplay() as steps:
        posed = options.read_problem(problem)
        folder = options.results_folder(out, f"{posed.name}-turn-chart")
        chart = rr.turn_chart(posed, progress=steps)
    show(chart, steps, folder, json=json)
