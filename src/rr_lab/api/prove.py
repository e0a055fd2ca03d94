"""The blind trial of the diagnosis on sealed cases."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from rr_lab.engines import ENGINES
from rr_lab.mujoco.plant import engine as mujoco
from rr_lab.random_case import KINDS
from rr_lab.report.trial import Proof, ProvedCase
from rr_lab.trial.child import one_case
from rr_lab.trial.lots import draw_lot, read_kinds, read_seed, seed_of_commit
from rr_lab.trial.trial import PACKAGE, Drawn, drawn_of, whole_trial
from rr_opt.batch.run import pool_of, run
from rr_opt.documents.archive import folder_for_results, write_bytes
from rr_opt.results.result import Result

Progress = Callable[[str], None]


@dataclass(frozen=True, repr=False)
class MadeCases(Result):
    """Cases that were made and sealed, to be diagnosed later."""

    folder: Path
    cases: int

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:  # noqa: ARG002
        """As plain data."""
        return {"status": "made", "cases": self.cases, "folder": str(self.folder)}

    def summary(self, files: Sequence[Path] = ()) -> str:  # noqa: ARG002
        """Where they are."""
        cases, answers = self.folder / "cases", self.folder / "answers"
        return f"{self.cases} cases in {cases}, their answers in {answers}\n"

    def save(self, *_: Any, **__: Any) -> list[Path]:
        """The files are there already."""
        return []


def prove(
    folder: Path,
    drawn: Drawn,
    cases: int = 100,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    restart: bool = False,
    make_only: bool = False,
    progress: Progress = lambda _: None,
) -> Proof | MadeCases:
    """Make and seal cases, diagnose each blind, then open and score them.

    An interrupted trial resumes when the same is asked for again. Raises InputError if the folder
    has another trial, or an answer that was changed.
    """
    with closing(pool_of(workers, scheduler)) as pool:
        opened = whole_trial(
            folder,
            drawn.seed,
            range(1, cases + 1),
            drawn.kinds,
            drawn.engines,
            keep=write_bytes,
            run=partial(run, pool),
            count=partial(_count, total=cases, progress=progress),
            restart=restart,
            make_only=make_only,
        )
    return Proof(opened) if opened else MadeCases(folder, cases)


def prove_case(
    folder: Path, drawn: Drawn, number: int, *, progress: Progress = lambda _: None
) -> ProvedCase:
    """Make one case of a trial again and diagnose it."""
    lot = draw_lot(drawn.seed, number, drawn.kinds, drawn.engines)
    place = folder / "again" / lot.id
    return ProvedCase(one_case(lot, place, write_bytes, progress), place)


def _count(words: str, steps: Iterator[int], done: int, total: int, progress: Progress) -> None:
    """Carry the steps out and show how many are done."""
    if done:
        progress(f"{done} of {total} cases were {words} in an earlier run.")
    try:
        progress(f"case {min(done + 1, total)} of {total}")
        for _ in steps:
            done += 1
            progress(f"case {min(done + 1, total)} of {total}")
    except KeyboardInterrupt:
        kept = f"{done} of {total} cases are {words}"
        raise KeyboardInterrupt(f"{kept} and kept. Repeat the command to resume.") from None


def drawn(
    folder: str | Path,
    *,
    seed: str | None = None,
    kinds: str | None = None,
    engine: str | None = None,
    resumed: bool = False,
) -> tuple[Path, Drawn]:
    """The trial's folder, and what its cases are drawn from.

    seed     hexadecimal; None: the hash of the commit
    kinds    `null, single:EFFECT, ...`; None: all but disturbed
    engine   mujoco, planar or both; None: both
    resumed  what is left out is as in the trial that is in the folder

    Raises InputError for what cannot be drawn, and for an engine that is not installed.
    """
    place = folder_for_results(Path(folder))
    found = _drawn(drawn_of(place) if resumed else None, seed, kinds, engine, place)
    # A missing engine is reported once, before any case.
    if "mujoco" in found.engines:
        mujoco()
    return place, found


def _drawn(
    begun: Drawn | None, seed: str | None, kinds: str | None, engine: str | None, folder: Path
) -> Drawn:
    """What the options say; what they leave out is as in the trial that was begun."""
    chosen = read_kinds(kinds) if kinds is not None else None
    word = begun.seed if begun and seed is None else _seed(seed, folder)
    # With another seed it is another trial.
    base = begun if begun and begun.seed == word else Drawn(word, KINDS, ENGINES)
    engines = {"both": ENGINES, "mujoco": ("mujoco",), "planar": ("planar",), None: base.engines}
    return Drawn(word, chosen or base.kinds, engines[engine])


def _seed(text: str | None, folder: Path) -> str:
    return seed_of_commit(PACKAGE, folder) if text in (None, "commit") else read_seed(text)
