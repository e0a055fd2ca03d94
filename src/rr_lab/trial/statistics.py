"""Rates, intervals, p-values and sizes over many cases."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import binomtest, kstest

from rr_lab.trial.case import Case


@dataclass(frozen=True)
class Rate:
    """count of total cases."""

    count: int
    total: int

    @property
    def fraction(self) -> float | None:
        """None where there is no case."""
        return self.count / self.total if self.total else None

    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval of the chance, Clopper and Pearson's, which covers at least that often."""
        if not self.total:
            return 0.0, 1.0
        found = binomtest(self.count, self.total).proportion_ci(0.95, method="exact")
        return float(found.low), float(found.high)

    @property
    def record(self) -> dict[str, Any]:
        """As plain data."""
        data = {"count": self.count, "total": self.total}
        return {**data, "fraction": self.fraction, "ci95": list(self.interval)}


def rate(flags: Iterable[bool]) -> Rate:
    """How many of the flags are set."""
    every = list(flags)
    return Rate(sum(every), len(every))


@dataclass(frozen=True)
class Measure:
    """name: short, for scripts; title: for people; definition: what is counted, of what."""

    name: str
    title: str
    definition: str
    rate: Rate


COVERAGE = (
    "Of the 95 % intervals of the parameters of effects that were named by their own name under "
    "the verdict `missing_physics`, and of wrong values named under `parameters`, those that "
    "contain the true value; 95 % of them should. Not counted: edge_x and edge_y of a floor patch, "
    "as any point on its edge is as good."
)
_ANY_POINT = ("edge_x", "edge_y")


@dataclass(frozen=True)
class Covered:
    """One interval and the truth, SI."""

    case: str
    name: str
    parameter: str
    true: float
    low: float
    high: float

    @property
    def held(self) -> bool:
        """Whether the interval holds the true value."""
        true = self.true
        if self.parameter == "normal":  # a direction, the same a turn on
            true += math.tau * round(((self.low + self.high) / 2 - true) / math.tau)
        return self.low <= true <= self.high

    @property
    def quantity(self) -> str:
        """`coulomb_friction.force1`, or the parameter itself."""
        return self.name if self.name == self.parameter else f"{self.name}.{self.parameter}"


def intervals(cases: Iterable[Case]) -> list[Covered]:
    """Every interval that has a true value to hold."""
    return [one for case in cases for one in _of(case)]


def by_quantity(every: Sequence[Covered]) -> dict[str, Rate]:
    """How many hold, for each quantity."""
    return {
        quantity: rate(one.held for one in every if one.quantity == quantity)
        for quantity in sorted({one.quantity for one in every})
    }


def _of(case: Case) -> list[Covered]:
    claim, values = case.claim, case.truth.values
    if claim is None or claim.verdict not in ("missing_physics", "parameters"):
        return []
    return [
        Covered(case.id, one.name, parameter, values[one.name][parameter], low, high)
        for one in claim.named
        for parameter, (low, high) in one.intervals.items()
        if parameter in values.get(one.name, {}) and parameter not in _ANY_POINT
    ]


P_VALUES = (
    "Where nothing is hidden the p-values of a test should be uniform between 0 and 1: the "
    "Kolmogorov-Smirnov distance, its own p-value, and how many are below 0.05."
)

FEWEST = 8
"""With fewer p-values nothing is reported."""


def evenness(cases: Sequence[Case]) -> dict[str, dict[str, Any]]:
    """By test: how many nulls have one, the distance, its chance, and how many are below 0.05."""
    found: dict[str, list[float]] = {}
    for case in cases:
        if case.truth.kind == "null" and case.claim and case.claim.p_values:
            for test, p in case.claim.p_values.items():
                found.setdefault(test, []).append(p)
    return {test: _uniformity(values) for test, values in found.items() if len(values) >= FEWEST}


def _uniformity(values: list[float]) -> dict[str, Any]:
    found = kstest(values, "uniform")
    return {
        "count": len(values),
        "distance": float(found.statistic),
        "chance": float(found.pvalue),
        "below_005": sum(p < 0.05 for p in values),
    }


HELD_OUT = (
    "RMS misfit of recordings that took no part in the fit, in units of the noise sigma: "
    "of the nominal model, with its parameters re-fitted, and with all effects found."
)
TIME = "Time of one diagnosis with its page, one process for each case, s."


@dataclass(frozen=True)
class Sizes:
    """Median, 90 % point and largest of some values; None where there are none."""

    median: float | None
    most: float | None
    largest: float | None
    count: int

    @property
    def record(self) -> dict[str, Any]:
        """As plain data."""
        return {
            "median": self.median,
            "quantile90": self.most,
            "largest": self.largest,
            "count": self.count,
        }


def sizes(values: Sequence[float | None]) -> Sizes:
    """Of the values that there are."""
    known = np.array([value for value in values if value is not None], float)
    if not known.size:
        return Sizes(None, None, None, 0)
    return Sizes(
        float(np.median(known)), float(np.quantile(known, 0.9)), float(known.max()), known.size
    )


def held_out(cases: Sequence[Case]) -> dict[str, dict[str, Sizes]]:
    """By kind: before, refitted, after."""
    table = {}
    for kind in dict.fromkeys(case.truth.kind for case in cases):
        claims = [case.claim for case in cases if case.truth.kind == kind and case.claim]
        table[kind] = {
            "before": sizes([claim.before for claim in claims]),
            "refitted": sizes([claim.refitted for claim in claims]),
            "after": sizes([claim.after for claim in claims]),
        }
    return table


def times(cases: Sequence[Case]) -> dict[str, Sizes]:
    """Wall and CPU time."""
    return {
        "wall": sizes([case.wall for case in cases]),
        "cpu": sizes([case.cpu for case in cases]),
    }
