"""proof.json: everything that was counted, each count with its definition."""

from __future__ import annotations

from typing import Any

from rr_opt.proof.opened import Opened
from rr_opt.proof.score import coverage, p_values, spread
from rr_opt.proof.score.by_engine import by_engine
from rr_opt.proof.score.case import Case
from rr_opt.proof.score.confusion import DEFINITION, confusion
from rr_opt.proof.score.measures import measures
from rr_opt.proof.score.rate import rate
from rr_opt.report.proof.words import hidden_text, said_text


def record(opened: Opened) -> dict[str, Any]:
    """The content of `proof.json`."""
    cases = opened.cases
    return {
        "status": "scored",
        "seed": opened.seed,
        "version": opened.version,
        "code_sha256": opened.code,
        "code_changed": opened.changed,
        "cases": len(cases),
        "measures": {
            one.name: {"definition": one.definition, **one.rate.record} for one in measures(cases)
        },
        "engines": {
            engine: {one.name: one.rate.record for one in own}
            for engine, own in by_engine(cases).items()
        },
        "confusion": _confusion(opened),
        "coverage": _coverage(opened),
        "held_out": {
            "definition": spread.HELD_OUT,
            "kinds": {
                kind: {when: sizes.record for when, sizes in row.items()}
                for kind, row in spread.held_out(cases).items()
            },
        },
        "time": {
            "definition": spread.TIME,
            **{name: sizes.record for name, sizes in spread.times(cases).items()},
            "making_cpu": spread.sizes(opened.made_seconds).record,
        },
        "p_values": {"definition": p_values.DEFINITION, "tests": p_values.evenness(cases)},
        "misses": [{**case_record(case), "page": page_of(case)} for case in opened.misses],
        "not_made": dict(opened.failed),
    }


def _confusion(opened: Opened) -> dict[str, Any]:
    table = confusion(opened.cases)
    return {
        "definition": DEFINITION,
        "rows": list(table.rows),
        "columns": list(table.columns),
        "counts": [
            [table.counts.get((row, col), 0) for col in table.columns] for row in table.rows
        ],
    }


def _coverage(opened: Opened) -> dict[str, Any]:
    every = coverage.intervals(opened.cases)
    return {
        "definition": coverage.DEFINITION,
        "all": rate(one.held for one in every).record,
        "quantities": {name: one.record for name, one in coverage.by_quantity(every).items()},
    }


def case_record(case: Case) -> dict[str, Any]:
    """What was hidden in a case, and what was said of it."""
    return {
        "case": case.id,
        "kind": case.truth.kind,
        "engine": case.truth.engine,
        "outcome": case.outcome,
        "counted": case.scored,
        "hidden": hidden_text(case),
        "said": said_text(case),
    }


def page_of(case: Case) -> str:
    """The diagnosis of a case that is kept, from the trial's folder."""
    return f"said/{case.id}/report.html" if case.claim else f"said/{case.id}/output.txt"
