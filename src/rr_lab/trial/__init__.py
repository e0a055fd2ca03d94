"""A trial: draw, record, seal, run the diagnosis, open and score.

Every case is sealed before the first is diagnosed. Two journals, `made.jsonl` and `said.jsonl`,
keep a line for each finished case, from which an interrupted trial resumes. In the trial's folder
`answers/ID.json` has what is hidden, `cases/ID/` the recordings, `said/ID/` what the diagnosis
wrote.
"""

import json
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.files import seal_of
from rr_lab.trial.draws import Basis, Draw, SealedCase, make
from rr_lab.trial.isolation import (
    COMMAND,
    OUTPUT,
    TIME_LIMIT,
    Reply,
    Task,
    diagnose_apart,
    opened_case,
)
from rr_lab.trial.outcome import Case, Claim
from rr_opt.batch.journal import Journal
from rr_opt.documents.archive import write_bytes
from rr_opt.outcome import InputError, NotConvergedError


@dataclass(frozen=True)
class OpenedTrial:
    """A finished trial.

    seed, code, version  the seed, the SHA-256 of the code, its version
    failed               cases that the laboratory could not make, by ID, and why
    made_seconds         CPU time of making each case
    changed              whether the code changed while the trial ran
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
        """Every case with a wrong answer, or none."""
        return tuple(case for case in self.cases if case.missed)


class OnDemand(dict[int, Any]):
    """value(key) for each of the keys, computed at each look-up; nothing is cached."""

    def __init__(self, keys: Iterable[int], value: Callable[[int], Any]):
        super().__init__(dict.fromkeys(keys))
        self._value = value

    def __getitem__(self, key: int) -> Any:
        super().__getitem__(key)
        return self._value(key)


MADE, SAID, SEALS = "made.jsonl", "said.jsonl", "seals.txt"

Run = Callable[[Callable[[Any], Any], Mapping[int, Any]], Iterator[tuple[int, Any]]]
"""Each task's key with function(task) as they finish; a text if its process died."""


@dataclass(frozen=True)
class Trial:
    """The cases of a trial, kept in a folder."""

    folder: Path
    draws: Sequence[Draw]

    def make(
        self, journal: Journal, run: Run, how: Callable[[Draw], SealedCase] = make
    ) -> Iterator[int]:
        """Make the cases missing in the journal; yields each case's number.

        At the end all seals are written, in the form that `sha256sum --check` reads.
        """
        tasks = {draw.number: draw for draw in self.draws if draw.number not in journal.rows}
        for number, made in run(how, tasks):
            journal.append(number, self._made(tasks[number].id, made))
            yield number
        seals = {draw.id: journal.rows[draw.number]["seal"] for draw in self.draws}
        lines = [f"{seal}  answers/{name}.json\n" for name, seal in seals.items() if seal]
        write_bytes(self.folder / SEALS, "".join(lines).encode())

    def _made(self, id: str, made: SealedCase | str) -> dict[str, Any]:
        """The row of a case that was made; its files are written first."""
        if isinstance(made, str) or made.failed:
            why = made if isinstance(made, str) else made.failed
            return {"seal": "", "failed": why, "seconds": None}
        _write(self.folder / "cases" / id, made.files)
        write_bytes(self.folder / "answers" / f"{id}.json", made.answer.encode())
        return {"seal": made.seal, "failed": "", "seconds": round(made.seconds, 2)}

    def diagnose(
        self,
        made: Mapping[int, Mapping[str, Any]],
        journal: Journal,
        run: Run,
        command: tuple[str, ...] = COMMAND,
        limit: float = TIME_LIMIT,
    ) -> Iterator[int]:
        """Diagnose the cases missing in the journal; yields each case's number."""
        ids = {draw.number: draw.id for draw in self.draws if made[draw.number]["seal"]}

        def task(number: int) -> Task:
            folder = self.folder / "cases" / ids[number]
            files = {path.name: path.read_bytes() for path in sorted(folder.iterdir())}
            return Task(files, command, limit)

        # Recordings are read one case at a time: all together they would fill the memory.
        wanted = OnDemand((number for number in ids if number not in journal.rows), task)
        for number, ended in run(diagnose_apart, wanted):
            # A text: the process running the diagnosis died.
            said = Reply(-1, {OUTPUT: ended.encode()}) if isinstance(ended, str) else ended
            place = self.folder / "said" / ids[number]
            shutil.rmtree(place, ignore_errors=True)
            _write(place, said.files)
            journal.append(number, said.row)
            yield number

    def open(
        self,
        made: Mapping[int, Mapping[str, Any]],
        said: Mapping[int, Mapping[str, Any]],
        identity: Mapping[str, Any],
    ) -> OpenedTrial:
        """Open every answer. Raises InputError if one is not what was sealed."""
        rows = {draw: made[draw.number] for draw in self.draws}
        return OpenedTrial(
            identity["seed"],
            identity["code"],
            identity["version"],
            tuple(
                opened_case(draw.id, self._unsealed(draw.id, row["seal"]), said[draw.number])
                for draw, row in rows.items()
                if not row["failed"]
            ),
            {draw.id: row["failed"] for draw, row in rows.items() if row["failed"]},
            tuple(float(row["seconds"]) for row in rows.values() if not row["failed"]),
        )

    def _unsealed(self, id: str, seal: str) -> dict[str, Any]:
        path = self.folder / "answers" / f"{id}.json"
        text = path.read_text(encoding="utf-8") if path.is_file() else ""
        if seal_of(text) != seal:
            raise InputError(
                f"The answer {path} has the SHA-256 {seal_of(text)}. Expected the one it was "
                f"sealed with, {seal}: it has been changed since. Start over with --restart."
            )
        return json.loads(text)


def _write(folder: Path, files: Mapping[str, bytes]) -> None:
    for name, content in files.items():
        write_bytes(folder / name, content)


def tidy(folder: Path, right: Sequence[str]) -> None:
    """Remove the recordings, which the seed can regenerate, and the output for the cases, by ID,
    that were diagnosed correctly."""
    for place in ("cases", *(f"said/{name}" for name in right)):
        shutil.rmtree(folder / place, ignore_errors=True)


def basis_of(folder: Path) -> Basis | None:
    """The settings of the trial in a folder; None if there is none."""
    journal = folder / MADE
    if not journal.is_file():
        return None
    with journal.open(encoding="utf-8", errors="replace") as lines:
        text = lines.readline()
    if not text.endswith("\n"):
        return None
    try:
        head = json.loads(text)
        return Basis(head["seed"], tuple(head["kinds"]), tuple(head["engines"]))
    except (ValueError, KeyError, TypeError, RecursionError):
        raise InputError(
            f"The journal {journal} is damaged in line 1. Expected the seed, kinds and engines "
            "of a trial. Start over with --restart."
        ) from None


def made_row(record: Mapping[str, Any]) -> Mapping[str, Any]:
    """The row of a case that was made. Raises KeyError or ValueError if it is not one."""
    _require(record, seal=str, failed=str)
    if not record["failed"]:
        _require(record, seconds=(int, float))
    return record


def said_row(record: Mapping[str, Any]) -> Mapping[str, Any]:
    """The row of a case that was diagnosed. Raises KeyError or ValueError if it is not one."""
    numbers = {"wall": (int, float), "cpu": (int, float)}
    _require(record, exit_code=int, timed_out=bool, **numbers, claim=(dict, type(None)))
    if record["claim"] is not None:
        try:
            Claim.of(record["claim"])
        except (AttributeError, KeyError, TypeError, ValueError) as error:
            raise ValueError(f"its claim cannot be read ({error!r})") from None
    return record


def _require(record: Mapping[str, Any], **kinds: type | tuple[type, ...]) -> None:
    for key, kind in kinds.items():
        if not isinstance(record[key], kind):
            raise ValueError(f"its {key} is {record[key]!r}")


def again(draw: Draw, folder: Path, progress: Callable[[str], None]) -> Case:
    """Make one case and diagnose it; everything is kept in the folder, the answer too.

    Raises NotConvergedError if the laboratory cannot make it.
    """
    progress("making the case")
    made = make(draw)
    if made.failed:
        raise NotConvergedError(f"The laboratory could not make case {draw.id}: {made.failed}")
    progress("diagnosing")
    said = diagnose_apart(Task(made.files))
    _write(folder / "recordings", made.files)
    _write(folder / "said", said.files)
    write_bytes(folder / "answer.json", made.answer.encode())
    return opened_case(draw.id, json.loads(made.answer), said.row)
