"""The counts of cases with one or two effects of the catalogue."""

from __future__ import annotations

from collections.abc import Sequence

from rr_opt.proof.lots import STRENGTHS
from rr_opt.proof.score.case import Case
from rr_opt.proof.score.measure import Measure
from rr_opt.proof.score.rate import rate
from rr_opt.proof.score.truth import FLOOR


def singles(cases: Sequence[Case]) -> list[Measure]:
    """Of cases with one effect."""
    seen = [case for case in cases if case.scored]
    hidden = [case for case in cases if not case.scored]
    by_strength = [
        Measure(
            f"single_{name}",
            f"... {name}",
            f"Of the same, those whose effect makes {low:g} to {high:g} sigma of difference before "
            "the re-fit, which names it.",
            rate(case.outcome == "right" for case in seen if case.truth.strength == name),
        )
        for name, (low, high) in STRENGTHS.items()
    ]
    return [
        Measure(
            "single",
            "single effects named",
            f"Of the cases with one effect that stays visible ({FLOOR:g} sigma or more) after the "
            "nominal parameters are re-fitted, those with the verdict `missing_physics` that name "
            "it, or one that the diagnosis says cannot be told from it, and nothing else.",
            rate(case.outcome == "right" for case in seen),
        ),
        *by_strength,
        Measure(
            "single_exact",
            "... by its own name",
            "Of the same, those that name the effect itself and nothing else.",
            rate(case.outcome == "right" and _exact(case) for case in seen),
        ),
        Measure(
            "single_invisible",
            "invisible, and no wrong name",
            f"Of the cases with one effect that leaves less than {FLOOR:g} sigma after the re-fit, "
            "those that answer and do not name another one.",
            rate(not case.missed for case in hidden),
        ),
    ]


def pairs(cases: Sequence[Case]) -> list[Measure]:
    """Of cases with two effects."""
    seen = [case for case in cases if case.scored]
    return [
        Measure(
            "pair_both",
            "pairs, both named",
            "Of the cases with two effects that both stay visible, those with the verdict "
            "`missing_physics` that name both and nothing else.",
            rate(case.outcome == "right" for case in seen),
        ),
        Measure(
            "pair_one",
            "... at least one named",
            "Of the same, those that name at least one of the two, under any verdict.",
            rate(bool(case.found) for case in seen),
        ),
        Measure(
            "pair_wrong",
            "... with a wrong name",
            "Of the same, those that name anything that is not hidden.",
            rate(bool(case.extra) for case in seen),
        ),
    ]


def _exact(case: Case) -> bool:
    return case.claim is not None and case.claim.names == case.truth.names
