"""How one diagnosis ended: as the row that a journal keeps, and as the case that is scored."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from rr_opt.proof.child import Said
from rr_opt.proof.score.case import Case
from rr_opt.proof.score.claim import claim_from, claim_record
from rr_opt.proof.score.truth import truth_from


def ended_row(said: Said | str) -> dict[str, Any]:
    """As plain data; a text: the process that had started the diagnosis died, and why."""
    if isinstance(said, str):
        said = Said(-1, {}, said, 0.0, 0.0)
    return {
        "exit_code": said.exit_code,
        "timed_out": said.timed_out,
        "wall": round(said.wall, 2),
        "cpu": round(said.cpu, 2),
        "claim": _claim(said),
    }


def ended_case(id: str, answer: Mapping[str, Any], row: Mapping[str, Any]) -> Case:
    """The case of an opened answer and such a row."""
    record = row["claim"]
    claim = claim_from(record) if record is not None else None
    why = "" if claim else _why(row)
    return Case(id, truth_from(answer), claim, row["wall"], row["cpu"], why)


def _claim(said: Said) -> dict[str, Any] | None:
    """What is scored of a diagnosis; None if the program failed or its answer cannot be read."""
    if said.exit_code != 0 or "diagnosis.json" not in said.files:
        return None
    try:
        return claim_record(json.loads(said.files["diagnosis.json"]))
    except (ValueError, KeyError, TypeError, AttributeError):
        return None


def _why(row: Mapping[str, Any]) -> str:
    """Why there is no answer."""
    if row["timed_out"]:
        return f"no answer after {row['wall']:.0f} s"
    if row["exit_code"]:
        return f"ended with exit code {row['exit_code']}"
    return "diagnosis.json is missing or cannot be read"
