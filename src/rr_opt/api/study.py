"""Studies: every case of one solved, kept as soon as it is, and resumed."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rr_opt.api.optimise import require_exact
from rr_opt.batch.journal import JOURNAL, Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.design.study.case import solve_case, solve_study
from rr_opt.design.study.plan import plan
from rr_opt.design.study.row import Row, row_from, row_record
from rr_opt.documents.archive import folder_for_results
from rr_opt.files.study_file import Study, read_study
from rr_opt.results.result import Progress, quiet
from rr_opt.results.study import SolvedStudy
from rr_opt.version import __version__

if TYPE_CHECKING:
    from rr_opt.batch.pools import Pool


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
    """Solve every case of a study, or of a study file; each begins at its neighbours' optima.

    folder     where finished rows are kept, so that the same call resumes after an interruption
    workers    processes here; None: one for each core. A script that uses more than one keeps its
               own work under `if __name__ == "__main__":`
    scheduler  of a dask cluster to work on instead, `tcp://HOST:PORT`
    cold       solve every case from cold starts alone
    restart    discard the rows of an earlier run

    Raises InputError for a folder with the rows of another study.
    """
    if not isinstance(asked, Study):
        asked = load_study(asked)
    require_exact(asked.problems[0])
    pool = partial(pool_of, workers, scheduler)
    if folder is None:
        return _solved(asked, {}, lambda *_: None, pool, progress, cold=cold)
    identity = {"input_sha256": asked.sha256, "version": __version__, "cold": cold}
    path, cases = folder_for_results(Path(folder)) / JOURNAL, len(asked.problems)
    with Journal(path, identity, read=row_from, cases=cases, restart=restart) as journal:
        rows = journal.rows
        if rows:
            progress(f"{len(rows)} of {cases} rows were solved in an earlier run.")

        def keep(case: int, row: Row) -> None:
            journal.append(case, row_record(row))

        try:
            return _solved(asked, rows, keep, pool, progress, cold=cold)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(
                f"{len(rows)} of {cases} rows are kept. Repeat the command to resume."
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
