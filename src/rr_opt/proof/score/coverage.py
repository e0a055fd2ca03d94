"""How often the 95 % intervals hold the true value, where the right thing was named."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rr_opt.proof.score.case import Case
from rr_opt.proof.score.rate import Rate, rate

DEFINITION = (
    "Of the 95 % intervals of the parameters of effects that were named by their own name under "
    "the verdict `missing_physics`, and of wrong values named under `parameters`, those that hold "
    "the true value; 95 % of them should. Not counted: edge_x and edge_y of a floor patch, as any "
    "point on its edge is as good."
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
