"""The answers of a trial, opened after everything is said, and held against their seals."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_opt.lab.answer import seal_of
from rr_opt.outcome import InputError
from rr_opt.proof.ended import ended_case
from rr_opt.proof.lots import Lot
from rr_opt.proof.score.case import Case


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
