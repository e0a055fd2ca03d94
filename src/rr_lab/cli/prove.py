"""`rr-opt prove`: sealed cases by lot, diagnosed blind, opened and scored."""

from __future__ import annotations

from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from rr_opt.cli.options import out_option
from rr_opt.cli.steps import Steps

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rr_lab.trial.trial import Drawn
    from rr_opt.batch.run import Pool


def prove(
    *,
    cases: Annotated[int, typer.Option(help="Number of cases.", min=1, max=999)] = 100,
    seed: Annotated[
        str | None,
        typer.Option(
            metavar="HEX", help="Random seed, hexadecimal.", show_default="hash of the commit"
        ),
    ] = None,
    kinds: Annotated[
        str | None,
        typer.Option(
            help="Only these: null, single, pair, parameters, outside, disturbed; or "
            "single:EFFECT, pair:EFFECT+EFFECT, outside:EFFECT, disturbed:NAME.",
            show_default="all but disturbed",
        ),
    ] = None,
    engine: Annotated[
        Literal["mujoco", "planar", "both"] | None,
        typer.Option(
            help="Physics engine: one of the two, or each for half of each kind.",
            show_default="both",
        ),
    ] = None,
    out: Annotated[Path | None, out_option("out/proof")] = None,
    workers: Annotated[
        int | None, typer.Option(help="Number of processes.", min=1, show_default="one per core")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="Work on a dask cluster: tcp://HOST:PORT of its scheduler.")
    ] = None,
    case: Annotated[
        int | None,
        typer.Option(
            metavar="ID",
            help="Make and diagnose only this case, of the trial in --out if there is one, and "
            "print the answer beside the diagnosis.",
            min=1,
        ),
    ] = None,
    make_only: Annotated[
        bool,
        typer.Option(
            "--make-only",
            help="Only make and seal the cases, as cases/ID and answers/ID.json; diagnose none.",
        ),
    ] = False,
    restart: Annotated[
        bool, typer.Option("--restart", help="Discard the cases of an earlier run.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print only proof.json on stdout.")] = False,
) -> None:
    """Test `diagnose` on sealed cases of the laboratory, and count how often it is right.

    An interrupted run resumes when the same command is repeated.
    """
    from rr_lab.mujoco.plant import engine as mujoco
    from rr_lab.trial.trial import drawn_of, tidy, whole_trial
    from rr_opt.batch.run import run
    from rr_opt.report.archive import folder_for_results, strict_json
    from rr_opt.report.archive import write_bytes as keep

    folder = folder_for_results(out or Path("out/proof"))
    begun = drawn_of(folder) if case is not None else None
    drawn = _drawn(begun, seed, kinds, engine, folder)
    # A laboratory without its engine is told before any case is, and not for each.
    if "mujoco" in drawn.engines:
        mujoco()
    if case is not None:
        typer.echo(_one(folder, drawn, case, json=json), nl=False)
        return
    with closing(_pool(workers, scheduler)) as pool:
        opened = whole_trial(
            folder,
            drawn.seed,
            range(1, cases + 1),
            drawn.kinds,
            drawn.engines,
            keep=keep,
            run=partial(run, pool),
            count=partial(_count, total=cases),
            restart=restart,
            make_only=make_only,
        )
    if opened is None:
        typer.echo(f"{cases} cases in {folder / 'cases'}, their answers in {folder / 'answers'}")
        return
    from rr_lab.report.trial import document, record, write_proof
    from rr_opt.report.text import terminal

    written = write_proof(opened, folder)
    tidy(folder, [case.id for case in opened.cases if not case.missed])
    text = strict_json(record(opened)) if json else terminal(document(opened), written)
    typer.echo(text, nl=False)


def _count(words: str, steps: Iterator[int], done: int, total: int) -> None:
    """Carry the steps out and show how many are done."""
    if done:
        typer.echo(f"{done} of {total} cases were {words} in an earlier run.", err=True)
    try:
        with Steps() as progress:
            progress(f"case {min(done + 1, total)} of {total}")
            for _ in steps:
                done += 1
                progress(f"case {min(done + 1, total)} of {total}")
    except KeyboardInterrupt:
        kept = f"{done} of {total} cases are {words}"
        typer.echo(f"{kept} and kept. Repeat the command to resume.", err=True)
        raise


def _one(folder: Path, drawn: Drawn, number: int, *, json: bool) -> str:
    """Make one case again, diagnose it, and tell what was hidden and what was said."""
    from rr_lab.report.trial import case_record, case_text
    from rr_lab.trial.child import one_case
    from rr_lab.trial.lots import draw_lot
    from rr_opt.report.archive import strict_json, write_bytes

    lot = draw_lot(drawn.seed, number, drawn.kinds, drawn.engines)
    place = folder / "again" / lot.id
    with Steps() as steps:
        found = one_case(lot, place, write_bytes, steps)
    return strict_json(case_record(found)) if json else case_text(found, place)


def _drawn(
    begun: Drawn | None, seed: str | None, kinds: str | None, engine: str | None, folder: Path
) -> Drawn:
    """What the options say; what they leave out is as in the trial that was begun."""
    from rr_lab.engines import ENGINES
    from rr_lab.random_case import KINDS
    from rr_lab.trial.lots import read_kinds
    from rr_lab.trial.trial import Drawn

    chosen = read_kinds(kinds) if kinds is not None else None
    word = begun.seed if begun and seed is None else _seed(seed, folder)
    # With another seed it is another trial.
    base = begun if begun and begun.seed == word else Drawn(word, KINDS, ENGINES)
    engines = {"both": ENGINES, "mujoco": ("mujoco",), "planar": ("planar",), None: base.engines}
    return Drawn(word, chosen or base.kinds, engines[engine])


def _seed(text: str | None, folder: Path) -> str:
    from rr_lab.trial.lots import read_seed, seed_of_commit
    from rr_lab.trial.trial import PACKAGE

    return seed_of_commit(PACKAGE, folder) if text in (None, "commit") else read_seed(text)


def _pool(workers: int | None, scheduler: str | None) -> Pool:
    if scheduler:
        from rr_opt.batch.cluster import ClusterPool

        return ClusterPool(scheduler)
    from rr_opt.batch.local import LocalPool

    return LocalPool(workers)
