"""Diagnosis against truth: a confusion matrix."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from rr_lab.random_case import SINGLES
from rr_lab.trial.case import Case

NOTHING, VALUE, NO_NAME = "nothing", "a wrong value", "no known effect"
SEVERAL, NONE = "several effects", "no answer"

_APART = ("pair", "disturbed")

DEFINITION = (
    "Rows are what was hidden, columns the diagnosis. Cases with one effect that stays visible, "
    "nothing, wrong values, or an effect outside the catalogue. A name that the diagnosis calls "
    "indistinguishable from the true one counts as the true one."
)


@dataclass(frozen=True)
class Confusion:
    """counts[row, column]; a row or a column without any case is left out."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    counts: dict[tuple[str, str], int]


def confusion(cases: Sequence[Case]) -> Confusion:
    """The table of all cases but pairs, disturbed ones, and effects that are invisible."""
    kept = [case for case in cases if case.truth.kind not in _APART and case.scored]
    counts = Counter((hidden_label(case), said_label(case)) for case in kept)
    order = (NOTHING, VALUE, *SINGLES, NO_NAME)
    rows = tuple(name for name in order if any(row == name for row, _ in counts))
    said = {column for _, column in counts}
    others = tuple(sorted(said - {*order, SEVERAL, NONE}))
    columns = tuple(
        name for name in (*order, *others, SEVERAL, NONE) if name in said or name in rows
    )
    return Confusion(rows, columns, dict(counts))


def hidden_label(case: Case) -> str:
    """The row of a case."""
    kind = case.truth.kind
    words = {"null": NOTHING, "parameters": VALUE, "outside": NO_NAME}
    return words.get(kind) or " + ".join(case.truth.hidden)


def said_label(case: Case) -> str:
    """The column of a case."""
    claim = case.claim
    if claim is None:
        return NONE
    if claim.verdict != "missing_physics":
        words = {"consistent": NOTHING, "parameters": VALUE, "unexplained": NO_NAME}
        return words.get(claim.verdict, claim.verdict)
    if len(claim.named) != 1:
        return SEVERAL
    return case.truth.names[0] if case.found else claim.names[0]
