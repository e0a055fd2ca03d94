"""Progress of a study on stderr: how many cases are done, and how long the others will take."""

from __future__ import annotations

import sys
from contextlib import closing
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Annotated, Any, Self

import typer

from rr_opt.cli import interrupt
from rr_opt.cli.problem_input import place
from rr_opt.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable

    from rr_opt.batch.run import Pool
    from rr_opt.design.study.row import Row
    from rr_opt.files.study_file import Study


class CaseProgress:
    """A context whose calls count finished cases; a bar with the time left, on a terminal only.

    A call also ends the work if the user has asked for it.
    """

    def __init__(self, done: int, total: int):
        self._done, self._total = done, total
        self._bar: Any = None
        self._task: Any = None

    def __enter__(self) -> Self:
        if sys.stderr.isatty():
            self._bar = _bar()
            self._task = self._bar.add_task("cases", total=self._total, completed=self._done)
            self._bar.start()
        return self

    def __call__(self) -> None:
        """One more case is finished."""
        interrupt.check()
        if self._bar is not None:
            self._bar.advance(self._task)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()


def _bar() -> Any:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        speed_estimate_period=60,
    )


def study(
    study: Annotated[Path, typer.Argument(help="Study file: a problem and what is varied.")],
    out: Annotated[
        Path | None,
        typer.Option(
            parser=place, metavar="DIR", help="Folder for the results.", show_default="out/NAME"
        ),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(help="Processes here.", min=1, show_default="one a core")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Solve on a dask cluster: tcp://HOST:PORT of its scheduler.")
    ] = None,
    cold: Annotated[
        bool, typer.Option("--cold", help="Solve every case from cold starts alone.")
    ] = False,
    restart: Annotated[
        bool, typer.Option("--restart", help="Forget the rows of an earlier run.")
    ] = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Write study.nc too.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print study.json alone on stdout.")] = False,
    figures: Annotated[
        bool, typer.Option("--figures/--no-figures", help="Draw figures and write report.html.")
    ] = True,
) -> None:
    """Solve a problem with many values of its keys: limits, the robot's parameters, bounds.

    A run that was stopped goes on where it was when the same command is given again.
    """
    from rr_opt.files.study_file import read_study

    asked, warnings = read_study(study)
    for warning in warnings:
        typer.echo(str(warning), err=True)
    from rr_opt.report.archive import folder_for_results, strict_json
    from rr_opt.report.study.page import check_wishes, write_study

    check_wishes(netcdf=netcdf)
    folder = folder_for_results(out or Path("out") / asked.name)
    rows = _rows(asked, folder, partial(_pool, workers, scheduler), cold=cold, restart=restart)
    from rr_opt.answers.study import StudyAnswer
    from rr_opt.report.study.page import record, summary

    result = StudyAnswer(asked, tuple(rows[case] for case in range(len(asked.problems))))
    written = write_study(result, folder, netcdf=netcdf, figures=figures)
    if json:
        typer.echo(strict_json(record(result)), nl=False)
    else:
        typer.echo(summary(result, written), nl=False)
    for sentence in result.warnings:
        typer.echo(sentence, err=True)
    if result.status.exit_code:
        raise typer.Exit(result.status.exit_code)


def _rows(
    asked: Study, folder: Path, pool_of: Callable[[], Pool], *, cold: bool, restart: bool
) -> dict[int, Row]:
    """Every case's row: those that the folder's journal has, and the others solved now."""
    from rr_opt.batch.journal import Journal
    from rr_opt.batch.run import run
    from rr_opt.design.study.case import solve_case, solve_study
    from rr_opt.design.study.plan import plan
    from rr_opt.design.study.row import row_from, row_record

    total = len(asked.problems)
    identity = {"input_sha256": asked.sha256, "version": __version__, "cold": cold}
    path = folder / "journal.jsonl"
    with Journal(path, identity, read=row_from, cases=total, restart=restart) as journal:
        rows = journal.rows
        if rows:
            typer.echo(f"{len(rows)} of {total} rows are there from an earlier run.", err=True)
        if len(rows) == total:
            return rows
        planned = plan([axis.numbers for axis in asked.axes], asked.shape)
        try:
            with closing(pool_of()) as pool, CaseProgress(len(rows), total) as progress:
                solve = partial(run, pool, solve_case)
                for case, row in solve_study(asked.problems, planned, rows, solve, cold=cold):
                    journal.append(case, row_record(row))
                    progress()
        except KeyboardInterrupt:
            typer.echo(
                f"{len(rows)} of {total} rows are kept. The same command goes on with the others.",
                err=True,
            )
            raise
    return rows


def _pool(workers: int | None, scheduler: str | None) -> Pool:
    if scheduler:
        from rr_opt.batch.cluster import ClusterPool

        return ClusterPool(scheduler)
    from rr_opt.batch.local import LocalPool

    return LocalPool(workers)
