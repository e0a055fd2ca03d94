"""The record of a trial: what was hidden in each case, what was said, and how it came out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.trial import statistics
from rr_lab.trial.counts import COUNTS, TEXTS, breakdown, by_engine, confusion
from rr_lab.trial.outcome import Case
from rr_lab.trial.statistics import Rate
from rr_lab.trial.trial import OpenedTrial
from rr_opt.documents.document import csv_text
from rr_opt.documents.rendering import columns
from rr_opt.formatting import number
from rr_opt.results.result import Result


def hidden_text(case: Case) -> str:
    """What was hidden, with its values in SI."""
    truth = case.truth
    if truth.nothing:
        return "nothing"
    if truth.kind == "parameters":
        return ", ".join(f"{name} = {number(of[name])}" for name, of in truth.values.items())
    # Of an effect outside the catalogue the answer has the values under `unknown`.
    values = truth.values if truth.names else {truth.hidden[0]: truth.values.get("unknown", {})}
    realised = truth.realised if truth.names else {}
    return " + ".join(
        _with_values(f"{name}/{realised[name]}" if name in realised else name, values.get(name, {}))
        for name in truth.hidden
    )


def _with_values(name: str, values: Mapping[str, float]) -> str:
    text = ", ".join(f"{key} {number(value, 3)}" for key, value in values.items())
    return f"{name} ({text})" if text else name


def size_text(case: Case) -> str:
    """How large: `12.3 σ, 0.8 σ re-fitted`; empty where nothing is hidden."""
    return "; ".join(
        f"{number(case.truth.size[name], 3)} σ, {number(case.truth.remains[name], 3)} σ re-fitted"
        for name in case.truth.hidden
    )


def said_text(case: Case) -> str:
    """Verdict and names with their confidence, or why there is none."""
    claim = case.claim
    if claim is None:
        return case.why_none
    names = ", ".join(f"{one.name} ({one.confidence:.2f})" for one in claim.named)
    return f"{claim.verdict}: {names}" if names else claim.verdict


def remainder_text(case: Case) -> str:
    """What the diagnosis says is left: `small, 3 %`; empty if it does not say."""
    claim = case.claim
    if claim is None or claim.share is None:
        return claim.remainder if claim else ""
    return f"{claim.remainder}, {100 * claim.share:.0f} % of the mismatch"


def page_of(case: Case) -> str:
    """The report of a case, from the trial's folder."""
    return f"said/{case.id}/report.html" if case.claim else f"said/{case.id}/output.txt"


def case_record(case: Case) -> dict[str, Any]:
    """What was hidden in a case, and the diagnosis."""
    return {
        "case": case.id,
        "kind": case.truth.kind,
        "engine": case.truth.engine,
        "outcome": case.outcome,
        "counted": case.scored,
        "hidden": hidden_text(case),
        "said": said_text(case),
        "remainder": remainder_text(case),
    }


@dataclass(frozen=True, repr=False)
class ProvedCase(Result):
    """One case, with what was hidden in it and what the diagnosis said; its files are in folder."""

    case: Case
    folder: Path

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:  # noqa: ARG002
        """Both as plain data."""
        return case_record(self.case)

    def summary(self) -> str:
        """Both for a terminal, with the folder of its files."""
        case = self.case
        rows = [
            ("case", case.id),
            ("kind", case.truth.kind),
            ("engine", case.truth.engine),
            ("disturbance", case.truth.disturbance),
            ("hidden", hidden_text(case)),
            ("size", size_text(case)),
            ("said", said_text(case)),
            ("remainder", remainder_text(case)),
            ("outcome", case.outcome + ("" if case.scored else " (undetectable, not counted)")),
            ("time", f"{case.wall:.0f} s, {case.cpu:.0f} s of CPU"),
            ("files", str(self.folder)),
        ]
        return "\n".join(columns([row for row in rows if row[1]])) + "\n"

    def save(self, *_: Any, **__: Any) -> list[Path]:
        """The files are there already."""
        return []


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
