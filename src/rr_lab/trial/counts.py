"""The counts of a trial, each with the sentence that defines it; and the confusion matrix."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rr_lab.engines import ENGINES
from rr_lab.random_case import SINGLES
from rr_lab.trial.draws import STRENGTHS
from rr_lab.trial.outcome import FLOOR, SURE, Case
from rr_lab.trial.statistics import Rate, coverage, intervals

Predicate = Callable[[Case], bool]


@dataclass(frozen=True)
class Count:
    """A count: of the cases that `among` picks, those for which `counted` holds.

    name   short, for scripts; title: for people
    """

    name: str
    title: str
    definition: str
    among: Predicate
    counted: Predicate

    def rate(self, cases: Sequence[Case]) -> Rate:
        """Among these cases."""
        return Rate.of(self.counted(case) for case in cases if self.among(case))


def _kind(kind: str, *, detectable: bool | None = None) -> Predicate:
    """Cases of a kind; detectable: only those whose effects are, or are not."""
    return lambda case: case.truth.kind == kind and detectable in (None, case.scored)


def _null(kind: str) -> Predicate:
    return lambda case: case.truth.kind == kind and case.truth.nothing


def _right(case: Case) -> bool:
    return case.outcome == "right"


def _came_out(outcome: str) -> Predicate:
    return lambda case: case.outcome == outcome


def _all_named(case: Case) -> bool:
    return _right(case) and len(case.found) == len(case.truth.names) and not case.extra


def _by_its_name(case: Case) -> bool:
    return _right(case) and case.claim is not None and case.claim.names == case.truth.names


def _nulls(name: str, off: float, words: str) -> Count:
    return Count(
        f"false_claims_{name}",
        f"... nominal values {words.partition(',')[0]}",
        f"Of the same, those whose nominal values are {words}.",
        lambda case: _null("null")(case) and case.truth.spread == off,
        _came_out("false claim"),
    )


def _single(name: str, low: float, high: float) -> Count:
    return Count(
        f"single_{name}",
        f"... {name}",
        f"Of the same, those whose effect has a size of {low:g} to {high:g} sigma before the "
        "re-fit.",
        lambda case: _kind("single", detectable=True)(case) and case.truth.strength == name,
        _right,
    )


COUNTS = (
    Count("false_claims", "nulls with a false claim",
          "Of the cases with nothing hidden, those whose verdict is not `consistent`; no answer is "
          "no claim.",
          _null("null"), _came_out("false claim")),
    _nulls("exact", 0.0, "true"),
    _nulls("off", 1.0, "off by chance, each as far as its uncertainty says"),
    Count("single", "single effects named",
          f"Of the cases with one effect that leaves at least {FLOOR:g} sigma after the nominal "
          "parameters are re-fitted, those with the verdict `missing_physics` that name it, or one "
          "that the diagnosis calls indistinguishable from it, and nothing else.",
          _kind("single", detectable=True), _right),
    *(_single(name, *ends) for name, ends in STRENGTHS.items()),
    Count("single_exact", "... by its own name",
          "Of the same, those that name the effect itself and nothing else.",
          _kind("single", detectable=True), _by_its_name),
    Count("single_invisible", "undetectable, no wrong name",
          f"Of the cases with one effect that leaves less than {FLOOR:g} sigma after the re-fit, "
          "those that answer and do not name another one.",
          _kind("single", detectable=False), lambda case: not case.missed),
    Count("pair_both", "pairs, both named",
          "Of the cases with two detectable effects, those with the verdict `missing_physics` that "
          "name both and nothing else.",
          _kind("pair", detectable=True), _right),
    Count("pair_one", "... at least one named",
          "Of the same, those that name at least one of the two, under any verdict.",
          _kind("pair", detectable=True), lambda case: bool(case.found)),
    Count("pair_wrong", "... with a wrong name",
          "Of the same, those that name anything that is not hidden.",
          _kind("pair", detectable=True), lambda case: bool(case.extra)),
    Count("parameters", "wrong values recognised",
          "Of the cases with one or two wrong nominal values, those with the verdict `parameters`, "
          "whichever it names.",
          _kind("parameters"), _right),
    Count("parameters_named", "... and every one named",
          "Of the same, those that name every wrong value, or one that the diagnosis calls "
          "indistinguishable from it, and no other.",
          _kind("parameters"), _all_named),
    Count("outside", "outside the catalogue, recognised",
          "Of the cases with a detectable effect that the catalogue does not have, those with the "
          f"verdict `unexplained` and no name of a confidence above {SURE:g}.",
          _kind("outside", detectable=True), _right),
    Count("outside_named", "... named with confidence",
          f"Of the same, those with a name of a confidence above {SURE:g}, under any verdict.",
          _kind("outside", detectable=True), _came_out("named with confidence")),
    Count("disturbed_false_claims", "disturbed nulls with a false claim",
          "Of the cases with disturbed recordings and nothing hidden, those whose verdict is not "
          "`consistent`.",
          _null("disturbed"), _came_out("false claim")),
    Count("disturbed_single", "disturbed, single effects named",
          "Of the cases with disturbed recordings and one detectable effect, those that name it "
          "and nothing else, as above.",
          lambda case: _kind("disturbed", detectable=True)(case) and not case.truth.nothing,
          _right),
    Count("no_answer", "no answer",
          "Of all cases, those whose diagnosis crashed, took too long or ended with an error; each "
          "counts as a miss above as well.",
          lambda _: True, lambda case: case.claim is None),
)  # fmt: skip
"""In the order to show them."""


BREAKDOWN = (
    "How many came out right. By effect and realisation: cases with one detectable effect; outside "
    "the catalogue, those with the verdict `unexplained`. By disturbance: cases with disturbed "
    "recordings in which nothing or one detectable effect is hidden."
)


def breakdown(cases: Sequence[Case]) -> dict[str, dict[str, Rate]]:
    """How many came out right by effect, by realisation where there are several, and by
    disturbance."""
    right: dict[str, dict[str, list[bool]]] = {"effect": {}, "realisation": {}, "disturbance": {}}
    for case in cases:
        for what, key in _rows(case).items():
            right[what].setdefault(key, []).append(_right(case))
    return {
        what: {key: Rate.of(flags) for key, flags in sorted(by_key.items())}
        for what, by_key in right.items()
    }


def _rows(case: Case) -> dict[str, str]:
    """The rows of the breakdown in which a case counts."""
    truth = case.truth
    if not case.scored or truth.kind not in ("single", "outside", "disturbed"):
        return {}
    if truth.kind == "disturbed":
        return {"disturbance": f"{truth.disturbance}, {'null' if truth.nothing else 'effect'}"}
    (name,) = truth.hidden
    if truth.kind == "outside" or name not in truth.realised:
        return {"effect": name}
    return {"effect": name, "realisation": f"{name}/{truth.realised[name]}"}


def by_engine(cases: Sequence[Case]) -> dict[str, dict[str, Rate]]:
    """By engine that drove any case: every count by name, and `coverage` of the intervals."""
    found = {}
    for engine in ENGINES:
        own = [case for case in cases if case.truth.engine == engine]
        if own:
            covered = coverage(intervals(own)).get("all", Rate(0, 0))
            found[engine] = {one.name: one.rate(own) for one in COUNTS} | {"coverage": covered}
    return found


TITLES = {one.name: one.title for one in COUNTS} | {"coverage": "intervals that cover the truth"}
"""By the name of a count."""

NOTHING, VALUE, NO_NAME = "nothing", "a wrong value", "no known effect"
SEVERAL, NONE = "several effects", "no answer"
_WORDS = {"null": NOTHING, "consistent": NOTHING, "parameters": VALUE, "outside": NO_NAME,
          "unexplained": NO_NAME}  # fmt: skip

CONFUSION = (
    "Rows are what was hidden, columns the diagnosis. Cases with one detectable effect, nothing, "
    "wrong values, or an effect outside the catalogue. A name that the diagnosis calls "
    "indistinguishable from the true one counts as the true one."
)


@dataclass(frozen=True)
class Confusion:
    """counts[row, column]; a row or a column without any case is left out."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    counts: dict[tuple[str, str], int]


def confusion(cases: Sequence[Case]) -> Confusion:
    """The table of all cases but pairs, disturbed ones, and undetectable effects."""
    kept = [case for case in cases if case.truth.kind not in ("pair", "disturbed") and case.scored]
    counts = Counter(
        (_WORDS.get(case.truth.kind) or " + ".join(case.truth.hidden), _said(case)) for case in kept
    )
    order = (NOTHING, VALUE, *SINGLES, NO_NAME)
    rows = tuple(name for name in order if any(row == name for row, _ in counts))
    said = {column for _, column in counts}
    others = sorted(said - {*order, SEVERAL, NONE})
    names = (*order, *others, SEVERAL, NONE)
    return Confusion(rows, tuple(n for n in names if n in said or n in rows), dict(counts))


def _said(case: Case) -> str:
    """The column of a case."""
    claim = case.claim
    if claim is None:
        return NONE
    if claim.verdict != "missing_physics":
        return _WORDS.get(claim.verdict, claim.verdict)
    if len(claim.named) != 1:
        return SEVERAL
    return case.truth.names[0] if case.found else claim.names[0]
