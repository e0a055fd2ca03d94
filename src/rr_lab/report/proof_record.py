"""proof.json and cases.csv: the counts of a trial, and a row for each case."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rr_lab.report.case import case_record, hidden_text, page_of, said_text
from rr_lab.trial import statistics
from rr_lab.trial.counts import COUNTS, TEXTS, breakdown, by_engine, confusion
from rr_lab.trial.outcome import Case
from rr_lab.trial.statistics import Rate
from rr_lab.trial.trial import OpenedTrial
from rr_opt.documents.document import csv_text


def _records(rates: Mapping[str, Rate]) -> dict[str, Any]:
    return {name: rate.record for name, rate in rates.items()}


def proof_record(opened: OpenedTrial) -> dict[str, Any]:
    """The content of `proof.json`."""
    cases, words = opened.cases, TEXTS["tables"]
    counted = confusion(cases)
    covered = _records(statistics.coverage(statistics.intervals(cases)))
    return {
        "status": "scored",
        "seed": opened.seed,
        "version": opened.version,
        "code_sha256": opened.code,
        "code_changed": opened.changed,
        "cases": len(cases),
        "measures": {
            one.name: {"definition": one.definition, **one.rate(cases).record} for one in COUNTS
        },
        "engines": {engine: _records(rates) for engine, rates in by_engine(cases).items()},
        "breakdown": {
            "definition": words["breakdown"],
            **{what: _records(rates) for what, rates in breakdown(cases).items()},
        },
        "confusion": {
            "definition": words["confusion"],
            "rows": list(counted.rows),
            "columns": list(counted.columns),
            "counts": [
                [counted.counts.get((row, column), 0) for column in counted.columns]
                for row in counted.rows
            ],
        },
        "coverage": {
            "definition": words["coverage"],
            "all": covered.pop("all", Rate(0, 0).record),
            "quantities": covered,
        },
        "held_out": {"definition": words["held_out"], "kinds": statistics.held_out(cases)},
        "remainder": {"definition": words["remainder"], "kinds": statistics.remainders(cases)},
        "time": {
            "definition": words["time"],
            **statistics.times(cases),
            "making_cpu": statistics.quantiles(opened.made_seconds),
        },
        "p_values": {"definition": words["p_values"], "tests": statistics.uniformity(cases)},
        "misses": [{**case_record(case), "page": page_of(case)} for case in opened.misses],
        "not_made": dict(opened.failed),
    }


def cases_csv(opened: OpenedTrial) -> str:
    """A row for each case; where there are two effects, sigma is that of the smaller one."""
    head = (
        "case", "kind", "engine", "strength", "nominal_off", "hidden", "visible_sigma",
        "refitted_sigma", "counted", "said", "outcome", "missed", "groups", "heldout_before",
        "heldout_refitted", "heldout_after", "wall_s", "cpu_s", "disturbance", "remainder",
        "remainder_share",
    )  # fmt: skip
    return csv_text(head, map(_row, opened.cases), digits=6)


def _row(case: Case) -> tuple[Any, ...]:
    truth, claim = case.truth, case.claim
    groups = ["|".join(sorted(group)) for group in claim.groups] if claim else []
    fit = (claim.before, claim.refitted, claim.after) if claim else (None,) * 3
    left = (claim.remainder, claim.share) if claim else (None,) * 2
    return (
        case.id, truth.kind, truth.engine, truth.strength, truth.spread > 0, hidden_text(case),
        min(truth.size.values(), default=None), min(truth.remains.values(), default=None),
        case.scored, said_text(case), case.outcome, case.missed, "; ".join(groups), *fit,
        case.wall, case.cpu, truth.disturbance, *left,
    )  # fmt: skip
