"""Studies: a problem with many values of its keys, each case kept as soon as it is solved."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, closing, nullcontext
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from rr_opt.api.load import PathLike
from rr_opt.api.optimise import require_exact
from rr_opt.batch.journal import JOURNAL, Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.design.study.case import solve_case, solve_study
from rr_opt.design.study.plan import plan
from rr_opt.design.study.row import row_from, row_record
from rr_opt.documents.archive import folder_for_results
from rr_opt.files.study_file import Study, read_study
from rr_opt.results.result import Progress, quiet
from rr_opt.results.study import SolvedStudy
from rr_opt.version import __version__

Kept = TypeVar("Kept")


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
    """Solve every case of a study, or of a study file, with warm starts from neighbours.

    folder     for finished rows, so that the same call resumes after an interruption
    workers    processes here; None: one for each core. A script that uses more than one keeps its
               own work under `if __name__ == "__main__":`
    scheduler  of a dask cluster to work on instead, `tcp://HOST:PORT`
    cold       no warm starts
    restart    discard the rows of an earlier run

    Raises InputError for a folder with the rows of another study.
    """
    if not isinstance(asked, Study):
        asked = load_study(asked)
    require_exact(asked.problems[0])
    identity = {"input_sha256": asked.sha256, "version": __version__, "cold": cold}
    total = len(asked.problems)
    with journal_in(folder, identity, row_from, total, restart) as journal:
        rows = dict(journal.rows) if journal else {}
        if rows:
            progress(f"{len(rows)} of {total} rows were solved in an earlier run.")
        try:
            if len(rows) < total:
                planned = plan([axis.numbers for axis in asked.axes], asked.shape)
                with closing(pool_of(workers, scheduler)) as pool:
                    progress(f"case {len(rows) + 1} of {total}")
                    solve = partial(run, pool, solve_case)
                    for case, row in solve_study(asked.problems, planned, rows, solve, cold=cold):
                        if journal:
                            journal.append(case, row_record(row))
                        rows[case] = row
                        progress(f"case {min(len(rows) + 1, total)} of {total}")
        except KeyboardInterrupt:
            if journal is None:
                raise
            raise KeyboardInterrupt(
                f"{len(journal.rows)} of {total} rows are kept. Repeat the command to resume."
            ) from None
    return SolvedStudy(asked, tuple(rows[case] for case in range(total)))


def journal_in(
    folder: PathLike | None,
    identity: Mapping[str, Any],
    read: Callable[[Mapping[str, Any]], Kept],
    cases: int,
    restart: bool,
) -> AbstractContextManager[Journal[Kept] | None]:
    """Where finished rows are kept, and those of an earlier run; None without a folder."""
    if folder is None:
        return nullcontext()
    path = folder_for_results(Path(folder)) / JOURNAL
    return Journal(path, identity, read=read, cases=cases, restart=restart)
