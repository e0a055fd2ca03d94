"""The blind trial of the diagnosis on sealed cases."""

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from rr_lab.case import ENGINES, Engine
from rr_lab.mujoco.plant import engine as mujoco
from rr_lab.report import Proof, ProvedCase
from rr_lab.trial import MADE, SAID, Trial, again, basis_of, made_row, said_row
from rr_lab.trial.draws import (
    CODE,
    KINDS,
    Basis,
    fingerprint,
    read_kinds,
    read_seed,
    seed_of_commit,
)
from rr_opt.batch.journal import Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.documents.archive import folder_for_results
from rr_opt.results.result import Progress, Result, quiet
from rr_opt.version import __version__


@dataclass(frozen=True, repr=False)
class MadeCases(Result):
    """Cases that were made and sealed, for a later diagnosis."""

    folder: Path
    cases: int

    def _record(self) -> dict[str, Any]:
        return {"status": "made", "cases": self.cases, "folder": str(self.folder)}

    def summary(self) -> str:
        """Their folder."""
        cases, answers = self.folder / "cases", self.folder / "answers"
        return f"{self.cases} cases in {cases}, their answers in {answers}\n"

    def save(self, *_: Any, **__: Any) -> list[Path]:
        """The files are there already."""
        return []


def prove(
    folder: Path,
    basis: Basis,
    cases: int = 100,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    restart: bool = False,
    make_only: bool = False,
    progress: Progress = quiet,
) -> Proof | MadeCases:
    """Make and seal cases, diagnose each blind, then open and score them.

    Called again with the same arguments, an interrupted trial resumes. Raises InputError if the
    folder has another trial, or an answer that was changed.
    """
    code, one_by_one = fingerprint(), range(1, cases + 1)
    drawn = {"seed": basis.seed, "kinds": list(basis.kinds), "engines": list(basis.engines)}
    identity = {**drawn, "code": code, "version": __version__}
    with (
        closing(pool_of(workers, scheduler)) as pool,
        Journal(folder / MADE, identity, read=made_row, restart=restart) as made,
        Journal(folder / SAID, identity, read=said_row, restart=restart) as said,
    ):
        trial = Trial(folder, [basis.draw(number) for number in one_by_one])

        def follow(words: str, steps: Iterator[int], journal: Journal) -> None:
            """Run the steps and show how many are done."""
            done = sum(number in journal.rows for number in one_by_one)
            if done:
                progress(f"{done} of {cases} cases were {words} in an earlier run.")
            try:
                progress(f"case {min(done + 1, cases)} of {cases}")
                for _ in steps:
                    done += 1
                    progress(f"case {min(done + 1, cases)} of {cases}")
            except KeyboardInterrupt:
                kept = f"{done} of {cases} cases have been {words} and are kept"
                raise KeyboardInterrupt(f"{kept}. Repeat the command to resume.") from None

        follow("made and sealed", trial.make(made, partial(run, pool)), made)
        if make_only:
            return MadeCases(folder, cases)
        follow("diagnosed", trial.diagnose(made.rows, said, partial(run, pool)), said)
        opened = trial.open(made.rows, said.rows, identity)
    return Proof(replace(opened, changed=fingerprint() != code))


def prove_case(
    folder: Path, basis: Basis, number: int, *, progress: Callable[[str], None] = quiet
) -> ProvedCase:
    """Remake one case of a trial and diagnose it."""
    draw = basis.draw(number)
    place = folder / "again" / draw.id
    return ProvedCase(again(draw, place, progress), place)


def basis(
    folder: str | Path,
    *,
    seed: str | None = None,
    kinds: str | None = None,
    engine: str | None = None,
    resumed: bool = False,
) -> tuple[Path, Basis]:
    """The trial's folder, and the settings its cases are drawn from.

    seed     hexadecimal; None: the hash of the commit
    kinds    `null, single:EFFECT, ...`; None: all
    engine   mujoco, planar or both; None: both
    resumed  defaults are those of the trial in the folder

    Raises InputError for invalid settings, and for an engine that is not installed.
    """
    place = folder_for_results(Path(folder))
    begun = basis_of(place) if resumed else None
    chosen = read_kinds(kinds) if kinds is not None else None
    if begun and seed is None:
        word = begun.seed
    elif seed in (None, "commit"):
        word = seed_of_commit(CODE[-1], place)
    else:
        word = read_seed(seed)
    # A different seed means a different trial.
    known = begun if begun and begun.seed == word else Basis(word, KINDS, ENGINES)
    engines: tuple[Engine, ...] = tuple(one for one in ENGINES if engine in (one, "both"))
    found = Basis(word, chosen or known.kinds, engines or known.engines)
    # A missing engine is reported once, before any case.
    if "mujoco" in found.engines:
        mujoco()
    return place, found
