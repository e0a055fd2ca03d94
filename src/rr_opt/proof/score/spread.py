"""Sizes over many cases: held-out misfit by kind, and time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_opt.proof.score.case import Case

HELD_OUT = (
    "RMS misfit of recordings that took no part in the fit, in sigma, of which 1 is the noise "
    "floor: of the model as believed, with its parameters alone re-fitted, and with all that was "
    "found."
)
TIME = "Time of one diagnosis with its page, one process a case, s."


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
