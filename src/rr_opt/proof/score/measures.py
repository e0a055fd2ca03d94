"""The counts of a trial, each with the sentence that defines it."""

from __future__ import annotations

from collections.abc import Sequence

from rr_opt.proof.score.case import SURE, Case
from rr_opt.proof.score.effect_measures import pairs, singles
from rr_opt.proof.score.measure import Measure
from rr_opt.proof.score.rate import rate

_NOMINAL = (
    ("exact", 0.0, "true", ""),
    ("off", 1.0, "off by chance", ", each as far as its uncertainty says"),
)


def measures(cases: Sequence[Case]) -> list[Measure]:
    """All counts, in the order to show them."""
    nulls = [case for case in cases if case.truth.kind == "null"]
    wrong = [case for case in cases if case.truth.kind == "parameters"]
    return [
        Measure(
            "false_claims",
            "nulls with a false claim",
            "Of the cases with nothing hidden, those whose verdict is not `consistent`; no answer "
            "is no claim.",
            rate(case.outcome == "false claim" for case in nulls),
        ),
        *(
            Measure(
                f"false_claims_{name}",
                f"... nominal values {words}",
                f"Of the same, those whose nominal values are {words}{more}.",
                rate(case.outcome == "false claim" for case in nulls if case.truth.spread == off),
            )
            for name, off, words, more in _NOMINAL
        ),
        *singles([case for case in cases if case.truth.kind == "single"]),
        *pairs([case for case in cases if case.truth.kind == "pair"]),
        Measure(
            "parameters",
            "wrong values told as such",
            "Of the cases with one or two wrong nominal values, those with the verdict "
            "`parameters`, whichever it names.",
            rate(case.outcome == "right" for case in wrong),
        ),
        Measure(
            "parameters_named",
            "... and every one named",
            "Of the same, those that name every wrong value, or one that the diagnosis says cannot "
            "be told from it, and no other.",
            rate(_all_named(case) for case in wrong),
        ),
        *_outside([case for case in cases if case.truth.kind == "outside"]),
        Measure(
            "no_answer",
            "no answer",
            "Of all cases, those whose diagnosis crashed, took too long or ended with an error; "
            "each counts as a miss above as well.",
            rate(case.claim is None for case in cases),
        ),
    ]


def _outside(cases: Sequence[Case]) -> list[Measure]:
    seen = [case for case in cases if case.scored]
    return [
        Measure(
            "outside",
            "outside the catalogue, flagged",
            "Of the cases with an effect that no name exists for and that stays visible, those "
            f"with the verdict `unexplained` and no name of a confidence above {SURE:g}.",
            rate(case.outcome == "right" for case in seen),
        ),
        Measure(
            "outside_named",
            "... named with confidence",
            f"Of the same, those with a name of a confidence above {SURE:g}, under any verdict.",
            rate(case.outcome == "named with confidence" for case in seen),
        ),
    ]


def _all_named(case: Case) -> bool:
    complete = len(case.found) == len(case.truth.names)
    return case.outcome == "right" and complete and not case.extra
