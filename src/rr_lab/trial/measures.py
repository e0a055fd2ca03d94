"""The counts of a trial, each with the sentence that defines it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rr_lab.engines import ENGINES
from rr_lab.trial.case import FLOOR, SURE, Case
from rr_lab.trial.lots import STRENGTHS
from rr_lab.trial.statistics import COVERAGE, Measure, Rate, intervals, rate


@dataclass(frozen=True)
class Count:
    """A count: of the cases that `among` picks, those for which `counted` holds.

    name   short, for scripts; title: for people
    """

    name: str
    title: str
    definition: str
    among: Callable[[Case], bool]
    counted: Callable[[Case], bool]

    def of(self, cases: Sequence[Case]) -> Measure:
        """Among these cases."""
        counted = rate(self.counted(case) for case in cases if self.among(case))
        return Measure(self.name, self.title, self.definition, counted)


def _kind(kind: str, *, visible: bool | None = None) -> Callable[[Case], bool]:
    """Cases of a kind, whose effects stay visible or do not, if that is asked for."""
    return lambda case: case.truth.kind == kind and (visible is None or case.scored == visible)


def _right(case: Case) -> bool:
    return case.outcome == "right"


def _false_claim(case: Case) -> bool:
    return case.outcome == "false claim"


def _nulls(name: str, off: float, words: str) -> Count:
    return Count(
        f"false_claims_{name}",
        f"... nominal values {words.partition(',')[0]}",
        f"Of the same, those whose nominal values are {words}.",
        lambda case: case.truth.kind == "null" and case.truth.spread == off,
        _false_claim,
    )


def _single(name: str, low: float, high: float) -> Count:
    return Count(
        f"single_{name}",
        f"... {name}",
        f"Of the same, those whose effect makes {low:g} to {high:g} sigma of difference before "
        "the re-fit, which names it.",
        lambda case: _kind("single", visible=True)(case) and case.truth.strength == name,
        _right,
    )


def _all_named(case: Case) -> bool:
    complete = len(case.found) == len(case.truth.names)
    return _right(case) and complete and not case.extra


COUNTS = (
    Count(
        "false_claims",
        "nulls with a false claim",
        "Of the cases with nothing hidden, those whose verdict is not `consistent`; no answer is "
        "no claim.",
        _kind("null"),
        _false_claim,
    ),
    _nulls("exact", 0.0, "true"),
    _nulls("off", 1.0, "off by chance, each as far as its uncertainty says"),
    Count(
        "single",
        "single effects named",
        f"Of the cases with one effect that stays visible ({FLOOR:g} sigma or more) after the "
        "nominal parameters are re-fitted, those with the verdict `missing_physics` that name it, "
        "or one that the diagnosis calls indistinguishable from it, and nothing else.",
        _kind("single", visible=True),
        _right,
    ),
    *(_single(name, *ends) for name, ends in STRENGTHS.items()),
    Count(
        "single_exact",
        "... by its own name",
        "Of the same, those that name the effect itself and nothing else.",
        _kind("single", visible=True),
        lambda case: (
            _right(case) and case.claim is not None and case.claim.names == case.truth.names
        ),
    ),
    Count(
        "single_invisible",
        "invisible, no wrong name",
        f"Of the cases with one effect that leaves less than {FLOOR:g} sigma after the re-fit, "
        "those that answer and do not name another one.",
        _kind("single", visible=False),
        lambda case: not case.missed,
    ),
    Count(
        "pair_both",
        "pairs, both named",
        "Of the cases with two effects that both stay visible, those with the verdict "
        "`missing_physics` that name both and nothing else.",
        _kind("pair", visible=True),
        _right,
    ),
    Count(
        "pair_one",
        "... at least one named",
        "Of the same, those that name at least one of the two, under any verdict.",
        _kind("pair", visible=True),
        lambda case: bool(case.found),
    ),
    Count(
        "pair_wrong",
        "... with a wrong name",
        "Of the same, those that name anything that is not hidden.",
        _kind("pair", visible=True),
        lambda case: bool(case.extra),
    ),
    Count(
        "parameters",
        "wrong values recognised",
        "Of the cases with one or two wrong nominal values, those with the verdict `parameters`, "
        "whichever it names.",
        _kind("parameters"),
        _right,
    ),
    Count(
        "parameters_named",
        "... and every one named",
        "Of the same, those that name every wrong value, or one that the diagnosis calls "
        "indistinguishable from it, and no other.",
        _kind("parameters"),
        _all_named,
    ),
    Count(
        "outside",
        "outside the catalogue, recognised",
        "Of the cases with an effect that no name exists for and that stays visible, those with "
        f"the verdict `unexplained` and no name of a confidence above {SURE:g}.",
        _kind("outside", visible=True),
        _right,
    ),
    Count(
        "outside_named",
        "... named with confidence",
        f"Of the same, those with a name of a confidence above {SURE:g}, under any verdict.",
        _kind("outside", visible=True),
        lambda case: case.outcome == "named with confidence",
    ),
    Count(
        "disturbed_false_claims",
        "disturbed nulls with a false claim",
        "Of the cases with disturbed recordings and nothing hidden, those whose verdict is not "
        "`consistent`.",
        lambda case: case.truth.kind == "disturbed" and not case.truth.hidden,
        _false_claim,
    ),
    Count(
        "disturbed_single",
        "disturbed, single effects named",
        "Of the cases with disturbed recordings and one effect that stays visible, those that name "
        "it and nothing else, as above.",
        lambda case: _kind("disturbed", visible=True)(case) and bool(case.truth.hidden),
        _right,
    ),
    Count(
        "no_answer",
        "no answer",
        "Of all cases, those whose diagnosis crashed, took too long or ended with an error; each "
        "counts as a miss above as well.",
        lambda _: True,
        lambda case: case.claim is None,
    ),
)


def measures(cases: Sequence[Case]) -> list[Measure]:
    """All counts, in the order to show them."""
    return [count.of(cases) for count in COUNTS]


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
