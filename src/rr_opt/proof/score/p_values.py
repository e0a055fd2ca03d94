"""Whether the p-values of each test are even between 0 and 1 where nothing is hidden."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from scipy.stats import kstest

from rr_opt.proof.score.case import Case

DEFINITION = (
    "Where nothing is hidden the p-values of a test should be even between 0 and 1: Kolmogorov and "
    "Smirnov's distance from that, and the chance of one so large; and how many are below 0.05."
)

FEWEST = 8
"""Of fewer p-values nothing is told."""


def evenness(cases: Sequence[Case]) -> dict[str, dict[str, Any]]:
    """By test: how many nulls have one, the distance, its chance, and how many are below 0.05."""
    found: dict[str, list[float]] = {}
    for case in cases:
        if case.truth.kind == "null" and case.claim and case.claim.p_values:
            for test, p in case.claim.p_values.items():
                found.setdefault(test, []).append(p)
    return {test: _told(values) for test, values in found.items() if len(values) >= FEWEST}


def _told(values: list[float]) -> dict[str, Any]:
    found = kstest(values, "uniform")
    return {
        "count": len(values),
        "distance": float(found.statistic),
        "chance": float(found.pvalue),
        "below_005": sum(p < 0.05 for p in values),
    }
