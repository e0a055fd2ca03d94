"""`rr-opt maximize-speed [PROBLEM]`: the fastest gait, checked, with the files that show it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rr_opt.cli.problem_input import name_of, read
from rr_opt.cli.steps import Steps
from rr_opt.outcome import Status

if TYPE_CHECKING:
    from rr_opt.problem import Problem
    from rr_opt.report.answer import Answer


def maximize_speed(
    problem: Annotated[
        Path | None,
        typer.Argument(
            help="Problem file, its folder, or a robot file; the paper's prototype if left out."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the results.", show_default="out/NAME")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", help="Print result.json alone on stdout.")
    ] = False,
    figures: Annotated[
        bool, typer.Option("--figures/--no-figures", help="Draw figures and write report.html.")
    ] = True,
) -> None:
    """Find the fastest gait of a problem.

    It is checked by simulation and against a plain sweep, and told with the limits that hold it.
    """
    with Steps() as steps:
        steps("reading")
        posed, sha256 = read(problem)
        from rr_opt.report.archive import folder_for_results, strict_json  # noqa: PLC0415

        name = name_of(problem)
        folder = folder_for_results(out or Path("out") / name)
        answer = _answer(posed, name, sha256, steps)
        from rr_opt.report.files import write_results  # noqa: PLC0415
        from rr_opt.report.result import result  # noqa: PLC0415
        from rr_opt.report.summary import summary  # noqa: PLC0415

        written = write_results(answer, folder, figures=figures, progress=steps)
    if json:
        typer.echo(strict_json(result(answer)), nl=False)
    else:
        typer.echo(summary(answer, written), nl=False)
    if answer.status is not Status.OPTIMAL:
        typer.echo(answer.message, err=True)
        raise typer.Exit(answer.status.exit_code)


def _answer(problem: Problem, name: str, sha256: str, steps: Steps) -> Answer:
    """Optimise, then check what was found: by simulation, and against a plain sweep."""
    from rr_opt.design.maximize_speed import maximize_speed as solve  # noqa: PLC0415
    from rr_opt.report.answer import Answer  # noqa: PLC0415
    from rr_opt.verify.replay import replay  # noqa: PLC0415
    from rr_opt.verify.sweep import check_optimum  # noqa: PLC0415

    optimum = solve(problem, steps)
    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    if best is None or robot is None or ratio is None:
        return Answer(name, sha256, optimum)
    steps("replay by CVODES")
    replayed = replay(robot, best.gait, problem.limits, best.speed)
    steps("check against a sweep")
    swept = check_optimum(problem, best.gait, ratio, best.speed)
    return Answer(name, sha256, optimum, replayed, swept)
