"""The counts of a trial, which `texts.toml` defines in words; and the confusion matrix."""

import tomllib
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from rr_lab.case import ENGINES
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


def _and(*conditions: Predicate) -> Predicate:
    return lambda case: all(condition(case) for condition in conditions)


def _spread(size: float) -> Predicate:
    return lambda case: case.truth.spread == size


def _strength(name: str) -> Predicate:
    return lambda case: case.truth.strength == name


_SINGLE, _PAIR = _kind("single", detectable=True), _kind("pair", detectable=True)
_OUTSIDE, _NULL = _kind("outside", detectable=True), _null("null")
_FALSE = _came_out("false claim")

_PREDICATES: dict[str, tuple[Predicate, Predicate]] = {
    "false_claims": (_NULL, _FALSE),
    "false_claims_exact": (_and(_NULL, _spread(0.0)), _FALSE),
    "false_claims_off": (_and(_NULL, _spread(1.0)), _FALSE),
    "single": (_SINGLE, _right),
    **{f"single_{name}": (_and(_SINGLE, _strength(name)), _right) for name in STRENGTHS},
    "single_exact": (_SINGLE, _by_its_name),
    "single_invisible": (_kind("single", detectable=False), lambda case: not case.missed),
    "pair_both": (_PAIR, _right),
    "pair_one": (_PAIR, lambda case: bool(case.found)),
    "pair_wrong": (_PAIR, lambda case: bool(case.extra)),
    "parameters": (_kind("parameters"), _right),
    "parameters_named": (_kind("parameters"), _all_named),
    "outside": (_OUTSIDE, _right),
    "outside_named": (_OUTSIDE, _came_out("named with confidence")),
    "disturbed_false_claims": (_null("disturbed"), _FALSE),
    "disturbed_single": (
        _and(_kind("disturbed", detectable=True), lambda case: not case.truth.nothing), _right,
    ),
    "no_answer": (lambda _: True, lambda case: case.claim is None),
}  # fmt: skip
"""By name: among which cases, and which of them are counted."""

TEXTS = tomllib.loads(Path(__file__).with_name("texts.toml").read_text(encoding="utf-8"))

_NUMBERS = {"floor": f"{FLOOR:g}", "sure": f"{SURE:g}"} | {
    name: f"{low:g} to {high:g}" for name, (low, high) in STRENGTHS.items()
}
COUNTS = tuple(
    Count(name, text["title"], text["definition"].format(**_NUMBERS), *_PREDICATES[name])
    for name, text in TEXTS["counts"].items()
)
"""In the order to show them."""


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
