"""Verbs that look for gaits: by the optimiser, over a study, and by plain sweeps."""

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


_STUDY = "Study file: a problem and what is varied, or route files."
_COLD = "Solve every case from scratch rather than from its neighbours."
_RESTART = "Discard the rows of an earlier run."


def study(
    study: Annotated[Path, typer.Argument(help=_STUDY)],
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    cold: Annotated[bool, typer.Option("--cold", help=_COLD)] = False,
    restart: Annotated[bool, typer.Option("--restart", help=_RESTART)] = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Also write study.nc.")] = False,
    json: Annotated[bool, options.json_option("study.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Solve a problem for many values of its keys.

    Keys are limits, robot parameters and bounds. With `routes`, drives several routes instead.
    An interrupted run resumes when the same command is repeated.
    """
    given = {"workers": workers, "scheduler": scheduler, "restart": restart}
    with StepDisplay() as steps:
        if options.names_routes(study):
            routes = options.read(rr.load_routes, study)
            folder = options.results_folder(out, routes.name)
            solved = rr.routes(routes, folder=folder, **given, progress=steps)
            more = {}
        else:
            asked = rr.load_study(study)
            folder = options.study_folder(out, asked.name, netcdf=netcdf)
            solved = rr.study(asked, folder=folder, **given, cold=cold, progress=steps)
            more = {"netcdf": netcdf}
    show(solved, steps, folder, json=json, figures=figures, **more)


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
