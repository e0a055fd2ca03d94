"""A trial from its seed to its opened answers: every case is sealed before the first is diagnosed.

Two journals, `made.jsonl` and `said.jsonl`, keep a line for each finished case, from which an
interrupted trial resumes. In the trial's folder `answers/ID.json` has what is hidden, `cases/ID/`
the recordings, `said/ID/` what the diagnosis wrote.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rr_lab.engines import Engine
from rr_lab.files import seal_of
from rr_lab.trial.case import Case
from rr_lab.trial.child import (
    COMMAND,
    TIME_LIMIT,
    Said,
    Task,
    diagnose_apart,
    ended_case,
    ended_row,
)
from rr_lab.trial.lots import Lot, Made, draw_lot, fingerprint, make
from rr_opt.batch.journal import Journal
from rr_opt.outcome import InputError
from rr_opt.version import __version__


class OnDemand(Mapping[int, Any]):
    """value(key) for each of the keys, in their order; nothing is kept."""

    def __init__(self, keys: Iterable[int], value: Callable[[int], Any]):
        self._keys = dict.fromkeys(keys)
        self._value = value

    def __getitem__(self, key: int) -> Any:
        if key not in self._keys:
            raise KeyError(key)
        return self._value(key)

    def __iter__(self) -> Iterator[int]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)


@dataclass(frozen=True)
class Opened:
    """A trial that is over.

    seed, code, version  what it was run with: the seed, the SHA-256 of the package, its version
    failed               cases that the laboratory could not make, by ID, and why
    made_seconds         CPU time of making each case
    changed              whether the package changed while the trial ran
    """

    seed: str
    code: str
    version: str
    cases: tuple[Case, ...]
    failed: Mapping[str, str]
    made_seconds: tuple[float, ...]
    changed: bool = False

    @property
    def misses(self) -> tuple[Case, ...]:
        """Every case that came out wrong, or without an answer."""
        return tuple(case for case in self.cases if case.missed)


def open_trial(
    folder: Path,
    lots: Sequence[Lot],
    made: Mapping[int, Mapping[str, Any]],
    said: Mapping[int, Mapping[str, Any]],
    identity: Mapping[str, Any],
) -> Opened:
    """Open every answer. Raises InputError if one is not what was sealed."""
    cases, failed, seconds = [], {}, []
    for lot in lots:
        row = made[lot.number]
        if row["failed"]:
            failed[lot.id] = row["failed"]
            continue
        seconds.append(float(row["seconds"]))
        answer = unsealed(folder, lot, row["seal"])
        cases.append(ended_case(lot.id, answer, said[lot.number]))
    return Opened(
        identity["seed"],
        identity["code"],
        identity["version"],
        tuple(cases),
        failed,
        tuple(seconds),
    )


def unsealed(folder: Path, lot: Lot, seal: str) -> dict[str, Any]:
    """An answer as plain data. Raises InputError if it is gone, or not what was sealed."""
    path = folder / "answers" / f"{lot.id}.json"
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    if seal_of(text) != seal:
        raise InputError(
            f"The answer {path} has the SHA-256 {seal_of(text)}. Expected that of its seal, "
            f"{seal}: it was changed after it was sealed. Begin anew with --restart."
        )
    return json.loads(text)


MADE, SAID = "made.jsonl", "said.jsonl"
SEALS = "seals.txt"

Run = Callable[[Callable[[Any], Any], Mapping[int, Any]], Iterator[tuple[int, Any]]]
"""Each task's key with function(task) as they are finished; a text where the process died."""


@dataclass(frozen=True)
class Trial:
    """folder: where it is kept; keep: writes a file whole or not at all; lots: the cases."""

    folder: Path
    keep: Callable[[Path, bytes], object]
    lots: Sequence[Lot]

    def make(self, journal: Journal, run: Run, how: Callable[[Lot], Made] = make) -> Iterator[int]:
        """Make the cases that the journal does not have; yields each case's number.

        At the end all seals are written, in the form that `sha256sum --check` reads.
        """
        tasks = {lot.number: lot for lot in self.lots if lot.number not in journal.rows}
        for number, made in run(how, tasks):
            journal.append(number, self._made(tasks[number], made))
            yield number
        seals = {lot.id: journal.rows[lot.number]["seal"] for lot in self.lots}
        lines = [f"{seal}  answers/{name}.json\n" for name, seal in seals.items() if seal]
        self.keep(self.folder / SEALS, "".join(lines).encode())

    def diagnose(
        self,
        made: Mapping[int, Mapping[str, Any]],
        journal: Journal,
        run: Run,
        command: tuple[str, ...] = COMMAND,
        limit: float = TIME_LIMIT,
    ) -> Iterator[int]:
        """Diagnose the cases made that the journal does not have; yields each case's number."""
        lots = {lot.number: lot for lot in self.lots}
        wanted = [n for n in lots if n not in journal.rows and made[n]["seal"]]

        def task(number: int) -> Task:
            folder = self.folder / "cases" / lots[number].id
            files = {path.name: path.read_bytes() for path in sorted(folder.iterdir())}
            return Task(files, command, limit)

        # Recordings are read when it is their turn: all together they would fill the memory.
        for number, said in run(diagnose_apart, OnDemand(wanted, task)):
            journal.append(number, self._said(lots[number], said))
            yield number

    def _made(self, lot: Lot, made: Made | str) -> dict[str, Any]:
        """The row of a case that was made; its files are written before it."""
        if isinstance(made, str) or made.failed:
            why = made if isinstance(made, str) else made.failed
            return {"seal": "", "failed": why, "seconds": None}
        for name, content in made.files.items():
            self.keep(self.folder / "cases" / lot.id / name, content)
        self.keep(self.folder / "answers" / f"{lot.id}.json", made.answer.encode())
        return {"seal": made.seal, "failed": "", "seconds": round(made.seconds, 2)}

    def _said(self, lot: Lot, said: Said | str) -> dict[str, Any]:
        """The row of a case that was diagnosed; its files are written before it."""
        place = self.folder / "said" / lot.id
        shutil.rmtree(place, ignore_errors=True)
        files = {"output.txt": said.encode()} if isinstance(said, str) else said.everything
        for name, content in files.items():
            self.keep(place / name, content)
        return ended_row(said)


def tidy(folder: Path, right: Sequence[str]) -> None:
    """Remove the recordings, which the seed makes again, and what was written of the cases, by ID,
    that came out right."""
    shutil.rmtree(folder / "cases", ignore_errors=True)
    for name in right:
        shutil.rmtree(folder / "said" / name, ignore_errors=True)


@dataclass(frozen=True)
class Drawn:
    """What the lots of a trial are drawn from: its seed, its kinds and its engines."""

    seed: str
    kinds: tuple[str, ...]
    engines: tuple[Engine, ...]


def drawn_of(folder: Path) -> Drawn | None:
    """What the trial in a folder is drawn from; None if there is none."""
    journal = folder / MADE
    if not journal.is_file():
        return None
    with journal.open(encoding="utf-8") as lines:
        text = lines.readline()
    if not text.endswith("\n"):
        return None
    head = json.loads(text)
    # Trials were all driven by MuJoCo before there was another engine to name.
    return Drawn(head["seed"], tuple(head["kinds"]), tuple(head.get("engines", ["mujoco"])))


PACKAGE = Path(__file__).parents[1]

Count = Callable[[str, Iterator[int], int], None]
"""Exhausts an iterator that yields a number for each case; the text says what is done with the
cases, the number how many are done already."""


def whole_trial(
    folder: Path,
    seed: str,
    numbers: range,
    kinds: tuple[str, ...],
    engines: tuple[Engine, ...],
    *,
    keep: Callable[[Path, bytes], object],
    run: Run,
    count: Count,
    restart: bool = False,
    make_only: bool = False,
) -> Opened | None:
    """Make every case, then diagnose every case, then open every answer.

    keep: writes a file whole; restart: what an earlier run left is forgotten; make_only: nothing is
    diagnosed and nothing opened. Raises InputError if the folder has another trial, or an answer
    that was changed.
    """
    code = fingerprint(PACKAGE)
    drawn = {"seed": seed, "kinds": list(kinds), "engines": list(engines)}
    identity = {**drawn, "code": code, "version": __version__}
    lots = [draw_lot(seed, number, kinds, engines) for number in numbers]
    trial = Trial(folder, keep, lots)
    with (
        Journal(folder / MADE, identity, restart=restart) as made,
        Journal(folder / SAID, identity, restart=restart) as said,
    ):
        count("made and sealed", trial.make(made, run), _done(made, numbers))
        if make_only:
            return None
        count("diagnosed", trial.diagnose(made.rows, said, run), _done(said, numbers))
        opened = open_trial(folder, lots, made.rows, said.rows, identity)
    return replace(opened, changed=fingerprint(PACKAGE) != code)


def _done(journal: Journal, numbers: range) -> int:
    return sum(number in journal.rows for number in numbers)
