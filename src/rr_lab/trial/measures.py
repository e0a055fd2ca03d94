"""The counts of a trial, each with the sentence that defines it."""

from __future__ import annotations

from collections.abc import Sequence

from rr_lab.engines import ENGINES
from rr_lab.trial.case import FLOOR, SURE, Case
from rr_lab.trial.lots import STRENGTHS
from rr_lab.trial.statistics import COVERAGE, Measure, Rate, intervals, rate


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
            "it, or one that the diagnosis calls indistinguishable from it, and nothing else.",
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
            "invisible, no wrong name",
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
            "wrong values recognised",
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
        *_disturbed([case for case in cases if case.truth.kind == "disturbed"]),
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
            "outside the catalogue, recognised",
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


def _disturbed(cases: Sequence[Case]) -> list[Measure]:
    nulls = [case for case in cases if not case.truth.hidden]
    return [
        Measure(
            "disturbed_false_claims",
            "disturbed nulls with a false claim",
            "Of the cases with disturbed recordings and nothing hidden, those whose verdict is not "
            "`consistent`.",
            rate(case.outcome == "false claim" for case in nulls),
        ),
        Measure(
            "disturbed_single",
            "disturbed, single effects named",
            "Of the cases with disturbed recordings and one effect that stays visible, those that "
            "name it and nothing else, as above.",
            rate(case.outcome == "right" for case in cases if case.truth.hidden and case.scored),
        ),
    ]


BREAKDOWN = (
    "How many came out right. By effect and realisation: cases with one visible effect; outside "
    "the catalogue, those with the verdict `unexplained`. By disturbance: cases with disturbed "
    "recordings in which nothing or one visible effect is hidden."
)


def breakdown(cases: Sequence[Case]) -> dict[str, dict[str, Rate]]:
    """How many came out right by effect, by realisation where there are several, and by
    disturbance."""
    right: dict[str, dict[str, list[bool]]] = {"effect": {}, "realisation": {}, "disturbance": {}}
    for case in cases:
        truth = case.truth
        if truth.kind in ("single", "outside") and case.scored:
            (name,) = truth.hidden
            keys = {"effect": name}
            if truth.kind == "single" and name in truth.realised:
                keys["realisation"] = f"{name}/{truth.realised[name]}"
        elif truth.kind == "disturbed" and case.scored:
            keys = {"disturbance": f"{truth.disturbance}, {'effect' if truth.hidden else 'null'}"}
        else:
            continue
        for what, key in keys.items():
            right[what].setdefault(key, []).append(case.outcome == "right")
    return {
        what: {key: rate(flags) for key, flags in sorted(by_key.items())}
        for what, by_key in right.items()
    }


def _all_named(case: Case) -> bool:
    complete = len(case.found) == len(case.truth.names)
    return case.outcome == "right" and complete and not case.extra


def by_engine(cases: Sequence[Case]) -> dict[str, list[Measure]]:
    """By engine that drove any case: all counts of `measures`, and that of the intervals."""
    found = {}
    for engine in ENGINES:
        own = [case for case in cases if case.truth.engine == engine]
        if own:
            held = rate(one.held for one in intervals(own))
            title = "intervals that contain the true value"
            covered = Measure("coverage", title, COVERAGE, held)
            found[engine] = [*measures(own), covered]
    return found


def side_by_side(cases: Sequence[Case]) -> list[tuple[str, list[Measure]]]:
    """Each count's title with the engines' own, in the order of `by_engine`; those of no case of
    any engine are left out."""
    together = zip(*by_engine(cases).values(), strict=True)
    return [(row[0].title, list(row)) for row in together if any(one.rate.total for one in row)]
