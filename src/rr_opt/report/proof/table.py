"""cases.csv: a row a case."""

from __future__ import annotations

import csv
import io
from typing import Any

from rr_opt.proof.opened import Opened
from rr_opt.proof.score.case import Case
from rr_opt.report.proof.words import hidden_text, said_text

HEAD = (
    "case", "kind", "engine", "strength", "nominal_off", "hidden", "visible_sigma",
    "refitted_sigma", "counted", "said", "outcome", "missed", "groups", "heldout_before",
    "heldout_refitted", "heldout_after", "wall_s", "cpu_s",
)  # fmt: skip


def csv_text(opened: Opened) -> str:
    """The table as CSV; where there are two effects the less visible one's sigma are told."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEAD)
    writer.writerows([_written(cell) for cell in _row(case)] for case in opened.cases)
    return text.getvalue()


def _row(case: Case) -> list[Any]:
    truth, claim = case.truth, case.claim
    groups = ["|".join(sorted(group)) for group in claim.groups] if claim else []
    return [
        case.id,
        truth.kind,
        truth.engine,
        truth.strength,
        truth.spread > 0,
        hidden_text(case),
        min(truth.seen.values(), default=None),
        min(truth.remains.values(), default=None),
        case.scored,
        said_text(case),
        case.outcome,
        case.missed,
        "; ".join(groups),
        claim.before if claim else None,
        claim.refitted if claim else None,
        claim.after if claim else None,
        case.wall,
        case.cpu,
    ]


def _written(cell: Any) -> Any:
    if isinstance(cell, bool):
        return "yes" if cell else "no"
    return "" if cell is None else f"{cell:.6g}" if isinstance(cell, float) else cell
