"""One case of a trial by itself: made again from its lot, diagnosed, opened."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from rr_opt.outcome import NotConvergedError
from rr_opt.proof.child import Task, diagnose_apart
from rr_opt.proof.ended import ended_case, ended_row
from rr_opt.proof.lots import Lot
from rr_opt.proof.make import make
from rr_opt.proof.score.case import Case


def one_case(
    lot: Lot, folder: Path, keep: Callable[[Path, bytes], object], steps: Callable[[str], None]
) -> Case:
    """Make the case of a lot and diagnose it; everything is kept in the folder, the answer too.

    Raises NotConvergedError if the laboratory cannot make it.
    """
    steps("making the case")
    made = make(lot)
    if made.failed:
        raise NotConvergedError(f"The laboratory could not make case {lot.id}: {made.failed}")
    steps("diagnosing")
    said = diagnose_apart(Task(made.files))
    for name, content in made.files.items():
        keep(folder / "recordings" / name, content)
    for name, content in said.everything.items():
        keep(folder / "said" / name, content)
    keep(folder / "answer.json", made.answer.encode())
    return ended_case(lot.id, json.loads(made.answer), ended_row(said))
