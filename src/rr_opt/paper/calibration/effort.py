"""How hard each model is searched: what a minute or two allows, by what a point costs."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.paper.calibration.models import Model


@dataclass(frozen=True)
class Effort:
    """How much of everything.

    log2_size  of the library, as a power of two
    slices     of each unknown, from whose best points a fit starts
    values     of a profile, with `starts` starts at each
    steps      of a descent
    sets       of made data, against which a fit is held
    """

    log2_size: int
    slices: int
    values: int
    starts: int
    steps: int
    sets: int


_CHEAP = Effort(log2_size=15, slices=12, values=25, starts=2, steps=20, sets=200)
_DEARER = Effort(log2_size=13, slices=8, values=0, starts=0, steps=15, sets=0)
_DEAR = Effort(log2_size=12, slices=5, values=11, starts=2, steps=9, sets=40)

CHAINS, SWEEPS = 100, 2400
"""Of the posterior sample of the viscous model."""

COVERAGE_SETS = 100
"""Of made data whose intervals are held against the truth."""


def effort(model: Model) -> Effort:
    """For a model."""
    if model.cost > 10:
        return _DEAR
    return _DEARER if model.cost > 2 else _CHEAP


OTHERS = {"viscous": {"log2_size": 14}, "viscous+dry": {"log2_size": 11, "slices": 3}}
"""What is done less under the other readings of J20/J10, by model."""
