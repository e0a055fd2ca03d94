"""A case of the blind trial in words."""

from __future__ import annotations

from collections.abc import Mapping

from rr_opt.proof.score.case import Case
from rr_opt.proof.score.rate import Rate
from rr_opt.report.quantities import number


def hidden_text(case: Case) -> str:
    """What was hidden, with its values in SI."""
    truth = case.truth
    if truth.kind == "null":
        return "nothing"
    if truth.kind == "parameters":
        return ", ".join(
            f"{name} = {number(values[name])}" for name, values in truth.values.items()
        )
    # Of an effect outside the catalogue the answer has the values under `unknown`.
    values = truth.values if truth.names else {truth.hidden[0]: truth.values.get("unknown", {})}
    return " + ".join(_with_values(name, values.get(name, {})) for name in truth.hidden)


def visible_text(case: Case) -> str:
    """How visible: `12.3 sigma, 0.8 after the re-fit`; empty where nothing is hidden."""
    return "; ".join(
        f"{number(case.truth.seen[name], 3)} σ, {number(case.truth.remains[name], 3)} σ re-fitted"
        for name in case.truth.hidden
    )


def said_text(case: Case) -> str:
    """Verdict and names with their confidence, or why there is none."""
    claim = case.claim
    if claim is None:
        return case.why_none
    names = ", ".join(f"{one.name} ({one.confidence:.2f})" for one in claim.named)
    return f"{claim.verdict}: {names}" if names else claim.verdict


def rate_text(rate: Rate) -> str:
    """`17 of 20`."""
    return f"{rate.count} of {rate.total}" if rate.total else "no case"


def share_text(rate: Rate) -> str:
    """`85 % (62 to 97)`."""
    if rate.fraction is None:
        return "–"
    low, high = rate.interval
    return f"{100 * rate.fraction:.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def _with_values(name: str, values: Mapping[str, float]) -> str:
    told = ", ".join(f"{key} {number(value, 3)}" for key, value in values.items())
    return f"{name} ({told})" if told else name
