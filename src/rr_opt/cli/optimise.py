"""Verbs that look for gaits: by the optimiser, and by plain sweeps."""

from pathlib import Path
from typing import Annotated

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay


def maximize_speed(
    problem: options.ProblemFile = None,
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    force: options.Force = False,
    json: Annotated[bool, options.json_option("result.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Find the fastest gait of a problem.

    The answer is checked by a simulation and a sweep, and reported with its active limits.
    """
    with StepDisplay() as steps:
        posed = options.read_problem(problem)
        folder = options.fastest_folder(out, posed.name, force=force)
        best = rr.maximize_speed(posed, progress=steps)
    show(best, steps, folder, json=json, figures=figures)


def shapes(
    problem: options.ProblemFile = None,
    out: Annotated[Path | None, options.out_option("out/NAME-shapes")] = None,
    json: Annotated[bool, options.json_option("shapes.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Compare the fastest sine with other waveforms.

    They have 3 harmonics, 5 harmonics, or any form. All satisfy the same limits, and each is
    checked. The problem's own shape is ignored.
    """
    with StepDisplay() as steps:
        posed = options.read_problem(problem)
        folder = options.results_folder(out, f"{posed.name}-shapes")
        compared = rr.shapes(posed, progress=steps)
    show(compared, steps, folder, json=json, figures=figures)


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
    with StepDisplay() as steps:
        posed = options.read_problem(problem)
        folder = options.results_folder(out, f"{posed.name}-sweep")
        swept = rr.sweep(posed, points, progress=steps)
    show(swept, steps, folder, json=json)
