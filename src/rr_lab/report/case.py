"""One case of a trial: what was hidden, what was said, and how it came out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_lab.trial.outcome import Case
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
    return f"{claim.remainder}, {claim.share:.0%} of the mismatch"


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

    def summary(self, files: Sequence[Path] = ()) -> str:  # noqa: ARG002
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
