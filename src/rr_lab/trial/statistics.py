"""Counts and statistics over the cases of a trial.

The counts, which `texts.toml` defines in words, with their intervals; the confusion matrix; the
coverage of intervals, the reliability of confidences, p-values, held-out errors, remainders and
times.
"""

from __future__ import annotations

import itertools
import math
import tomllib
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import binomtest, kstest

from rr_lab.case import ENGINES
from rr_lab.random_case import SINGLES
from rr_lab.trial.draws import STRENGTHS
from rr_lab.trial.outcome import FLOOR, SURE, Case


@dataclass(frozen=True)
class Rate:
    """count of total cases."""

    count: int
    total: int

    @classmethod
    def of(cls, flags: Iterable[bool]) -> Rate:
        """How many of the flags are set."""
        every = list(flags)
        return cls(sum(every), len(every))

    @property
    def fraction(self) -> float | None:
        """None where there is no case."""
        return self.count / self.total if self.total else None

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the probability by Clopper and Pearson (Biometrika 26, 404, 1934), with
        at least that coverage."""
        if not self.total:
            return 0.0, 1.0
        found = binomtest(self.count, self.total).proportion_ci(0.95, method="exact")
        return float(found.low), float(found.high)

    @property
    def record(self) -> dict[str, Any]:
        """As plain data."""
        data = {"count": self.count, "total": self.total}
        return {**data, "fraction": self.fraction, "ci95": list(self.interval)}


_ANY_POINT = ("edge_x", "edge_y")
"""Of a floor patch; any point on its edge is equivalent."""


@dataclass(frozen=True)
class Interval:
    """The interval of a quantity such as `coulomb_friction.force1`, and the true value, SI."""

    quantity: str
    true: float
    low: float
    high: float

    @property
    def covers(self) -> bool:
        """Whether it contains the true value."""
        true = self.true
        if self.quantity.endswith(".normal"):  # a direction, modulo a turn
            true += math.tau * round(((self.low + self.high) / 2 - true) / math.tau)
        return self.low <= true <= self.high


def intervals(cases: Iterable[Case]) -> list[Interval]:
    """Every interval whose true value is known."""
    return [one for case in cases for one in _of(case)]


def _of(case: Case) -> list[Interval]:
    claim, values = case.claim, case.truth.values
    if claim is None or claim.verdict not in ("missing_physics", "parameters"):
        return []
    return [
        Interval(
            one.name if one.name == parameter else f"{one.name}.{parameter}",
            values[one.name][parameter],
            *ends,
        )
        for one in claim.named
        for parameter, ends in one.intervals.items()
        if parameter in values.get(one.name, {}) and parameter not in _ANY_POINT
    ]


def coverage(every: Sequence[Interval]) -> dict[str, Rate]:
    """How many intervals cover the truth: `all`, then each quantity; empty without intervals."""
    by_quantity = {
        name: Rate.of(one.covers for one in every if one.quantity == name)
        for name in sorted({one.quantity for one in every})
    }
    return {"all": Rate.of(one.covers for one in every), **by_quantity} if every else {}


_BANDS = (0.0, 0.5, 0.7, 0.85, 1.0)
"""Edges of the bands in which confidences are counted: they crowd at 0.7 and 0.9."""


def reliability(cases: Iterable[Case]) -> dict[str, tuple[float, Rate]]:
    """By band of confidence: the mean confidence of the names in it, and how many are right."""
    named = [
        (one.confidence, one.name not in case.extra)
        for case in cases
        for one in (case.claim.named if case.claim else ())
    ]
    table = {}
    for low, high in itertools.pairwise(_BANDS):
        own = [(stated, right) for stated, right in named if low < stated <= high]
        if own:
            mean = float(np.mean([stated for stated, _ in own]))
            table[f"{low:g} to {high:g}"] = mean, Rate.of(right for _, right in own)
    return table


FEWEST = 8
"""Fewest p-values that are reported."""


def uniformity(cases: Sequence[Case]) -> dict[str, dict[str, Any]]:
    """By test: how many nulls have one, the distance, its chance, and how many are below 0.05."""
    found: dict[str, list[float]] = {}
    for case in cases:
        if case.truth.kind == "null" and case.claim:
            for test, p in case.claim.p_values.items():
                found.setdefault(test, []).append(p)
    table = {}
    for test, values in found.items():
        if len(values) >= FEWEST:
            against = kstest(values, "uniform")
            table[test] = {
                "count": len(values),
                "distance": float(against.statistic),
                "chance": float(against.pvalue),
                "below_005": sum(p < 0.05 for p in values),
            }
    return table


SIZES = ("none", "small", "large")


def quantiles(values: Iterable[float | None]) -> dict[str, Any]:
    """Median, 90 % point, largest and count of the existing values."""
    known = np.array([value for value in values if value is not None], float)
    if not known.size:
        return {"median": None, "quantile90": None, "largest": None, "count": 0}
    return {
        "median": float(np.median(known)),
        "quantile90": float(np.quantile(known, 0.9)),
        "largest": float(known.max()),
        "count": known.size,
    }


def by_kind(cases: Sequence[Case]) -> dict[str, list[Case]]:
    """The cases with an answer, by kind, in order of first appearance."""
    kinds = dict.fromkeys(case.truth.kind for case in cases)
    return {kind: [c for c in cases if c.truth.kind == kind and c.claim] for kind in kinds}


def held_out(cases: Sequence[Case]) -> dict[str, dict[str, dict[str, Any]]]:
    """By kind: before, refitted, after."""
    return {
        kind: {
            when: quantiles(getattr(case.claim, when) for case in own)
            for when in ("before", "refitted", "after")
        }
        for kind, own in by_kind(cases).items()
    }


def remainders(cases: Sequence[Case]) -> dict[str, dict[str, Any]]:
    """By kind: how many answers state no, a small or a large remainder, and the median share."""
    table = {}
    for kind, own in by_kind(cases).items():
        claims = [case.claim for case in own if case.claim and case.claim.remainder]
        counted = Counter(claim.remainder for claim in claims)
        shares = quantiles(claim.share for claim in claims)
        if claims:
            table[kind] = {size: counted[size] for size in SIZES} | {"share": shares["median"]}
    return table


def times(cases: Sequence[Case]) -> dict[str, dict[str, Any]]:
    """Wall and CPU time."""
    return {name: quantiles(getattr(case, name) for case in cases) for name in ("wall", "cpu")}


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


def _kind(kind: str) -> Predicate:
    """Cases of a kind, with everything that is hidden detectable."""
    return lambda case: case.truth.kind == kind and case.scored


def _strength(name: str) -> Predicate:
    return lambda case: case.scored and case.truth.strength == name


def _outcome(outcome: str) -> Predicate:
    return lambda case: case.outcome == outcome


def _all_named(case: Case) -> bool:
    return _RIGHT(case) and len(case.found) == len(case.truth.names) and not case.extra


def _by_its_name(case: Case) -> bool:
    return _RIGHT(case) and case.claim is not None and case.claim.names == case.truth.names


def _suspects(case: Case) -> bool:
    return case.claim is not None and bool(case.claim.suspects)


def _rightly(case: Case) -> bool:
    return case.claim is not None and set(case.claim.suspects) <= set(case.truth.hidden)


_RIGHT, _FALSE = _outcome("right"), _outcome("false claim")
_NULL, _SINGLE, _PAIR, _OUTSIDE = map(_kind, ("null", "single", "pair", "outside"))
_PARAMETERS, _DISTURBED = map(_kind, ("parameters", "disturbed"))

_PREDICATES: dict[str, tuple[Predicate, Predicate]] = {
    "false_claims": (_NULL, _FALSE),
    "false_claims_exact": (lambda case: _NULL(case) and case.truth.spread == 0.0, _FALSE),
    "false_claims_off": (lambda case: _NULL(case) and case.truth.spread == 1.0, _FALSE),
    "single": (_SINGLE, _RIGHT),
    **{f"single_{name}": (_strength(name), _RIGHT) for name in STRENGTHS},
    "single_exact": (_SINGLE, _by_its_name),
    "single_invisible": (
        lambda case: case.truth.kind == "single" and not case.scored,
        lambda case: not case.missed,
    ),
    "pair_both": (_PAIR, _RIGHT),
    "pair_one": (_PAIR, lambda case: bool(case.found)),
    "pair_wrong": (_PAIR, lambda case: bool(case.extra)),
    "parameters": (_PARAMETERS, _RIGHT),
    "parameters_named": (_PARAMETERS, _all_named),
    "outside": (_OUTSIDE, _RIGHT),
    "outside_named": (_OUTSIDE, _outcome("named with confidence")),
    "suspected": (_suspects, _rightly),
    "disturbed_false_claims": (lambda case: _DISTURBED(case) and case.truth.nothing, _FALSE),
    "disturbed_single": (lambda case: _DISTURBED(case) and not case.truth.nothing, _RIGHT),
    "no_answer": (lambda _: True, lambda case: case.claim is None),
}
"""By name: the cases considered, and those counted."""

TEXTS = tomllib.loads(Path(__file__).with_name("texts.toml").read_text(encoding="utf-8"))

_NUMBERS = {
    "floor": f"{FLOOR:g}",
    "sure": f"{SURE:g}",
    # The size that was reached may lie outside the ranges of those that were drawn.
    "faint": f"less than {STRENGTHS['medium'][0]:g}",
    "medium": "{:g} to {:g}".format(*STRENGTHS["medium"]),
    "strong": f"at least {STRENGTHS['medium'][1]:g}",
}
COUNTS = tuple(
    Count(name, text["title"], text["definition"].format(**_NUMBERS), *_PREDICATES[name])
    for name, text in TEXTS["counts"].items()
)
"""In the order to show them."""


def breakdown(cases: Sequence[Case]) -> dict[str, dict[str, Rate]]:
    """Correct diagnoses by effect, by realisation if there are several, and by disturbance."""
    right: dict[str, dict[str, list[bool]]] = {"effect": {}, "realisation": {}, "disturbance": {}}
    for case in cases:
        for what, key in _rows(case).items():
            right[what].setdefault(key, []).append(_RIGHT(case))
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
    """By engine: every count by name, and `coverage` of the intervals."""
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
    """counts[row, column]; empty rows and columns are omitted."""

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
    hidden, said = {row for row, _ in counts}, {column for _, column in counts}
    others = sorted((hidden | said) - {*order, SEVERAL, NONE})
    names = (*order, *others, SEVERAL, NONE)
    rows = tuple(n for n in names if n in hidden)
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
