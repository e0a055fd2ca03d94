"""A trial in its order: every case is made and sealed before the first is diagnosed.

Two journals keep what is finished, `made.jsonl` and `said.jsonl`, a line a case: a trial that was
stopped, however, goes on behind them. In the trial's folder `answers/ID.json` has what is hidden,
`cases/ID/` the recordings, `said/ID/` what the diagnosis wrote.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_opt.batch.journal import Journal
from rr_opt.lab.engines import Engine
from rr_opt.proof.child import COMMAND, TIME_LIMIT, Said, Task, diagnose_apart
from rr_opt.proof.ended import ended_row
from rr_opt.proof.lots import Lot
from rr_opt.proof.make import Made, make
from rr_opt.proof.on_demand import OnDemand

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
