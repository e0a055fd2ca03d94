"""The verbs, in the order of the help. A verb parses, calls the library and prints."""

import json as json_text
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Literal

import typer

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay
from rr_opt.outcome import EXIT_WRONG_INPUT


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
        folder = options.results_folder(out, posed.name)
        options.require_same_turn(folder, {}, force)
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
        words = options.turn_words(asked | {"cycles": cycles})
        folder = options.results_folder(out, "-".join([posed.name, "turn", *words]))
        whole = {**dict.fromkeys(options.TURN_UNITS), **asked, "cycles": cycles}
        options.require_same_turn(folder, whole, force)
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


def route(
    route: Annotated[Path, typer.Argument(help="Route file: where to drive, and how exactly.")],
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    json: Annotated[bool, options.json_option("route.json")] = False,
    figures: options.Figures = True,
    feedback: Annotated[
        bool,
        typer.Option(
            "--feedback", help="Also write the controller that keeps the robot on it: JSON and C."
        ),
    ] = False,
    animate: options.Film = None,
) -> None:
    """Drive a route from rest, as fast as the robot can.

    A route consists of straights, arcs and waypoints. The drive is checked by simulation. `rr-opt
    init route` writes a file to start from.
    """
    with StepDisplay() as steps:
        asked = options.read(rr.load_route, route)
        folder = options.motion_folder(out, asked.name, animate)
        driven = rr.route(asked, feedback=feedback, progress=steps)
    show(driven, steps, folder, json=json, figures=figures, film=animate)


def simulate(
    source: options.Driven = None,
    *,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    seconds: options.Seconds = 10.0,
    start: options.From = "rest",
    rate: options.Samples = 100.0,
    out: options.MotionFolder = None,
    kind: options.Trajectory = "csv",
    animate: options.Film = None,
    json: options.Summary = False,
) -> None:
    """Simulate a gait for some time.

    Writes the trajectory, a figure and, on request, an animation.
    """
    with StepDisplay() as steps:
        with options.naming(source):
            gait = {"amplitude": amplitude, "period": period, "offset": offset}
            driven = options.read_gait(source, **gait, seconds=seconds, rate=rate)
        name = f"{options.result_name(source)}-motion"
        folder = options.motion_folder(out, name, animate, kind)
        with options.naming(source):
            motion = rr.simulate(driven, None, seconds, start=start, rate=rate, progress=steps)
    show(motion, steps, folder, json=json, format=kind, film=animate)


def circle(
    source: options.Driven = None,
    *,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    json: options.Summary = False,
) -> None:
    """Compute the circle that a gait drives.

    Prints radius, centre, speed, the time for a full turn, and how a start from rest approaches
    the circle. Left is positive, seen from above.
    """
    with StepDisplay() as steps, options.naming(source):
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        answer = rr.circle(options.read_gait(source, **gait), progress=steps)
    show(answer, json=json)


def export(
    source: options.Driven = None,
    *,
    kind: options.SetPoints = "csv",
    rate: options.PointRate = None,
    keep_period: options.KeepPeriod = False,
    within_limits: options.WithinLimits = True,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    out: options.PointFile = None,
    json: options.Summary = False,
) -> None:
    """Write a gait as set points for a controller.

    The period is adjusted to a whole number of set points. If the gait or a step between set points
    is beyond the limits, the amplitude is lowered. The loss of speed is reported separately for the
    adjusted period, the straight lines between set points, and rounding to counts.
    """
    from rr_opt.documents.archive import file_for_result
    from rr_opt.results.setpoints import ENDINGS

    with StepDisplay() as steps:
        with options.naming(source):
            gait = {"amplitude": amplitude, "period": period, "offset": offset}
            driven = options.read_gait(source, **gait, rate=rate)
        name = f"{options.result_name(source)}{ENDINGS[kind]}"
        file = file_for_result(out or Path("out") / name)
        with options.naming(source):
            points = rr.export(
                driven,
                format=kind,
                rate=rate,
                keep_period=keep_period,
                within_limits=within_limits,
                progress=steps,
            )
    show(points, steps, file, json=json)


_COLD = "Solve every case from scratch rather than from its neighbours."


def study(
    study: Annotated[
        Path, typer.Argument(help="Study file: a problem and what is varied, or route files.")
    ],
    out: Annotated[Path | None, options.out_option("out/NAME")] = None,
    workers: options.Workers = None,
    scheduler: options.Scheduler = None,
    cold: Annotated[bool, typer.Option("--cold", help=_COLD)] = False,
    restart: Annotated[
        bool, typer.Option("--restart", help="Discard the rows of an earlier run.")
    ] = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Also write study.nc.")] = False,
    json: Annotated[bool, options.json_option("study.json")] = False,
    figures: options.Figures = True,
) -> None:
    """Solve a problem for many values of its keys.

    Keys are limits, robot parameters and bounds. With `routes`, drives several routes instead.
    An interrupted run resumes when the same command is repeated.
    """
    from rr_opt.documents.archive import netcdf_writer
    from rr_opt.files.route_file import is_of_routes
    from rr_opt.files.source import read_document

    given = {"workers": workers, "scheduler": scheduler, "restart": restart}
    with StepDisplay() as steps:
        if is_of_routes(read_document(study)):
            routes = options.read(rr.load_routes, study)
            folder = options.results_folder(out, routes.name)
            solved = rr.routes(routes, folder=folder, **given, progress=steps)
            more = {}
        else:
            asked = rr.load_study(study)
            if netcdf:
                netcdf_writer()  # which may not be there
            folder = options.results_folder(out, asked.name)
            solved = rr.study(asked, folder=folder, **given, cold=cold, progress=steps)
            more = {"netcdf": netcdf}
    show(solved, steps, folder, json=json, figures=figures, **more)


def inspect(
    source: options.Recorded,
    *,
    layout: options.Layout = None,
    servo_log: options.ServoLog = None,
    columns: options.Columns = None,
    amplitude: options.CommandedAmplitude = None,
    period: options.CommandedPeriod = None,
    offset: options.CommandedOffset = None,
    start: options.Start = "running",
    out: Annotated[Path | None, options.out_option("out/NAME-inspect")] = None,
    netcdf: options.NetCDF = None,
    figures: options.Figures = True,
    json: Annotated[bool, options.json_option("inspection.json")] = False,
) -> None:
    """Read a recording, clean it, and list every warning.

    Outliers are flagged, and gaps stay gaps. Writes inspection.json and report.html.
    """
    from rr_opt.api.recordings import check_files, name_of

    with StepDisplay() as steps:
        steps("reading")
        gait = options.read_command(amplitude=amplitude, period=period, offset=offset)
        check_files(source, netcdf)
        folder = options.results_folder(out, f"{name_of(source)}-inspect")
        given = {"layout": layout, "servo_log": servo_log, "gait": gait, "start": start}
        named = options.read_columns(columns)
        found = rr.inspect(source, columns=named, **given, progress=steps)
    more = {"netcdf": netcdf} if netcdf else {}
    show(found, steps, folder, json=json, figures=figures, **more)


def diagnose(
    source: Annotated[
        Path,
        typer.Argument(metavar="FOLDER", help="Folder with an experiment.yaml and its recordings."),
    ],
    out: Annotated[Path | None, options.out_option("out/NAME-diagnosis")] = None,
    json: Annotated[bool, options.json_option("diagnosis.json")] = False,
    page: Annotated[
        bool, typer.Option("--page/--no-page", help="Draw figures and write report.html.")
    ] = True,
) -> None:
    """Find out why recordings differ from the simulation.

    Says where, by which physics, and how certainly. Writes diagnosis.json, robot-corrected.yaml
    for the other verbs, and report.html.
    """
    with StepDisplay() as steps:
        steps("reading")
        experiment = rr.load_experiment(source)
        folder = options.results_folder(out, f"{experiment.name}-diagnosis")
        found = rr.diagnose(experiment, progress=steps)
    show(found, steps, folder, json=json, figures=page)


_KIND = "robot, problem, study, experiment or route."
_OUT = "The file to write; for an experiment, its folder."


def init(
    kind: Annotated[
        Literal["robot", "problem", "study", "experiment", "route"], typer.Argument(help=_KIND)
    ] = "problem",
    out: Annotated[Path | None, options.out_option("KIND.yaml", _OUT)] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite existing files.")] = False,
) -> None:
    """Write a commented input file with units, to be filled in.

    An experiment is a folder with simulated recordings, which `rr-opt diagnose` reads as they are.
    """
    for file in rr.init(kind, out, force=force):
        typer.echo(str(file))


_FILES = (
    "Robot, problem, study, route or experiment files, or folders with a problem.yaml or an "
    "experiment.yaml, whose recordings are read too."
)


def lint(
    files: Annotated[list[Path], typer.Argument(help=_FILES)],
    json: Annotated[bool, typer.Option("--json", help="Print JSON on stdout.")] = False,
) -> None:
    """Check input files and list every mistake in them. Exits with 2 if there is an error."""
    from rr_opt.files.issue import has_errors

    checked = {str(file): rr.lint(file) for file in files}
    wrong = any(has_errors(issues) for issues in checked.values())
    if json:
        found = [asdict(issue) for issues in checked.values() for issue in issues]
        typer.echo(json_text.dumps({"ok": not wrong, "issues": found}, indent=2))
    else:
        for name, issues in checked.items():
            for issue in issues:
                typer.echo(str(issue))
            if not has_errors(issues):
                typer.echo(f"{name}: OK")
    if wrong:
        raise typer.Exit(EXIT_WRONG_INPUT)


def schema(
    kind: Annotated[str, typer.Argument(help=f"Kind of file: {_KIND}")],
    machine: Annotated[
        str, typer.Option(help="For an experiment: racer, pendulum, servo or car.")
    ] = "racer",
) -> None:
    """Print the JSON Schema of an input file. Editors complete and check files with it."""
    typer.echo(json_text.dumps(rr.schema(kind, machine), indent=2))
