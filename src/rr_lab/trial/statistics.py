"""Rates, intervals, p-values and quantiles over many cases."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import binomtest, kstest

from rr_lab.trial.outcome import Case


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
        """95 % interval of the probability by Clopper and Pearson (Biometrika 26, 404, 1934), which
        covers at least that often."""
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
"""Of a floor patch; any point on its edge is as good."""


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
        if self.quantity.endswith(".normal"):  # a direction, the same a turn on
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


FEWEST = 8
"""With fewer p-values nothing is reported."""


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
    """Median, 90 % point, largest and count of the values that there are."""
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
    """The cases with an answer, by kind, in the order in which kinds first come."""
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
    """By kind: how many answers say that none, a small or a large remainder is left, and the median
    share."""
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
