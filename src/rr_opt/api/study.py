"""A problem solved with many values of its keys."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

from rr_opt.answers.study import StudyAnswer
from rr_opt.api.result import Plots, Progress, Result, quiet
from rr_opt.batch.journal import Journal
from rr_opt.batch.run import Pool, pool_of, run
from rr_opt.design.study.case import solve_case, solve_study
from rr_opt.design.study.plan import plan
from rr_opt.design.study.row import Row, row_from, row_record
from rr_opt.files.study_file import Study, read_study
from rr_opt.report.archive import folder_for_results
from rr_opt.version import __version__

JOURNAL = "journal.jsonl"


class SolvedStudy(Result, StudyAnswer):
    """A study with all its rows.

    rows     one for each case, in the order of `study.problems`; `row.optimum` is None where there
             is none, and `row.message` says why
    speed    |speed| of every case, m/s, as an array; nan where there is no optimum
    fastest  the number of the fastest case
    """

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of study.json: the table row by row, and the gaits."""
        from rr_opt.report.study import record

        return record(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """How many cases were solved, and the fastest, as text."""
        from rr_opt.report.study import summary

        return summary(self, list(files))

    def plot(self) -> Plots:
        """Speed over what was varied, what limits it, and what it costs."""
        from rr_opt.report.figures.active_limits import draw

        return Plots(draw(self))

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        netcdf: bool = False,
    ) -> list[Path]:
        """Write study.csv, study.json and, if asked for, study.nc, with figures and page."""
        from rr_opt.report.study import write_study

        check_files(netcdf=netcdf)
        return write_study(self, folder_for_results(Path(path)), netcdf=netcdf, figures=figures)


def check_files(*, netcdf: bool) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    from rr_opt.report.study import check_wishes

    check_wishes(netcdf=netcdf)


def load_study(path: str | Path) -> Study:
    """The study of a file. Raises InputError with everything that is wrong in any case."""
    return read_study(path)[0]


def study(
    asked: Study | str | Path,
    *,
    folder: str | Path | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    cold: bool = False,
    restart: bool = False,
    progress: Progress = quiet,
) -> SolvedStudy:
    """Solve every case of a study, or of a study file; neighbours begin at neighbours' optima.

    folder     where finished rows are kept, so that the same call goes on after an interruption
    workers    processes here; None: one for each core. A script that uses more than one keeps its
               own work under `if __name__ == "__main__":`
    scheduler  of a dask cluster to work on instead, `tcp://HOST:PORT`
    cold       solve every case from cold starts alone
    restart    discard the rows of an earlier run

    Raises InputError for a folder that holds the rows of another study.
    """
    if not isinstance(asked, Study):
        asked = load_study(asked)
    pool = partial(pool_of, workers, scheduler)
    if folder is None:
        return _solved(asked, {}, lambda *_: None, pool, progress, cold=cold)
    identity = {"input_sha256": asked.sha256, "version": __version__, "cold": cold}
    path, cases = folder_for_results(Path(folder)) / JOURNAL, len(asked.problems)
    with Journal(path, identity, read=row_from, cases=cases, restart=restart) as journal:
        rows = journal.rows
        if rows:
            progress(f"{len(rows)} of {cases} rows are there from an earlier run.")

        def keep(case: int, row: Row) -> None:
            journal.append(case, row_record(row))

        try:
            return _solved(asked, rows, keep, pool, progress, cold=cold)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(
                f"{len(rows)} of {cases} rows are kept. The same command goes on with the others."
            ) from None


def _solved(
    asked: Study,
    rows: dict[int, Row],
    keep: Callable[[int, Row], object],
    open_pool: Callable[[], Pool],
    progress: Progress,
    *,
    cold: bool,
) -> SolvedStudy:
    """With the rows that are not there yet solved, each kept as soon as it is."""
    rows, total = dict(rows), len(asked.problems)
    if len(rows) < total:
        planned = plan([axis.numbers for axis in asked.axes], asked.shape)
        with closing(open_pool()) as pool:
            progress(f"case {len(rows) + 1} of {total}")
            solve = partial(run, pool, solve_case)
            for case, row in solve_study(asked.problems, planned, rows, solve, cold=cold):
                keep(case, row)
                rows[case] = row
                progress(f"case {min(len(rows) + 1, total)} of {total}")
    return SolvedStudy(asked, tuple(rows[case] for case in range(total)))
