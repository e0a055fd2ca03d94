"""How near a reading of the paper can come to its nine averages, whatever else is open.

What Table 1 leaves out is fitted within a box: a1 and a2 (c1 and c2 follow from c1 - a1 and
c2 - a2), one half track b and one friction k for all wheels, and Table 2's amplitude. Table 1's
masses and inertias stand. The sign of the speed is one for all rows, whichever fits better.

Chi-square counts in standard errors, half_width/t with t = 4.303 of n = 3 runs. Those are
themselves known from two degrees of freedom only, so its usual thresholds do not hold.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import least_squares

from rr_opt.paper.equation3 import CORRECTED, Signs
from rr_opt.paper.nine_rows import BOX, ROWS, predicted, prototype
from rr_opt.paper.printed import RUNS
from rr_opt.paper.readings import Reading

Array = NDArray[np.float64]
Column = Literal["mean", "other"]
COLUMNS: tuple[Column, ...] = ("mean", "other")

STUDENT = float(stats.t.ppf(0.975, RUNS - 1))
"""t of the paper's intervals: half_width = t s/sqrt(n)."""

_SCREENED, _STARTS, _APART, _SEED = 400, 8, 0.6, 1
"""Points tried; how many of the best of them are fitted from, for each sign, and how far these lie
apart at least, in the unit box."""
_HOPELESS = 100.0
"""Residual of a row that has no steady speed, in standard errors."""


@dataclass(frozen=True)
class Fit:
    """The best that was found.

    values     of the unknowns, by name; those that were fixed among them
    predicted  speeds of the nine rows, m/s, signed so that most are positive
    chi2       of the nine rows; free: how many unknowns were fitted
    """

    values: Mapping[str, float]
    predicted: tuple[float, ...]
    chi2: float
    free: int


def fit(
    reading: Reading,
    column: Column,
    *,
    signs: Signs = CORRECTED,
    fixed: Mapping[str, float] | None = None,
) -> Fit:
    """Fit the unknowns of BOX that are not fixed to a column of Tables 2 and 3."""
    fixed = fixed or {}
    names = [name for name in BOX if name not in fixed]
    ends = np.array([[_inner(name, end) for end in BOX[name]] for name in names])
    seen = np.array([getattr(row, column) for row in ROWS])
    error = np.array([row.half_width for row in ROWS]) / STUDENT

    def values(point: Array) -> dict[str, float]:
        return {**fixed, **{n: _outer(n, x) for n, x in zip(names, point, strict=True)}}

    def speeds(point: Array) -> Array:
        all_values = values(point)
        amplitude = all_values.pop("amplitude")
        return predicted(prototype(**all_values), reading, amplitude, signs)

    unit = stats.qmc.LatinHypercube(len(names), rng=_SEED).random(_SCREENED)
    screened = ends[:, 0] + unit * (ends[:, 1] - ends[:, 0])
    tried = np.array([speeds(point) for point in screened])
    best: tuple[float, Array, float] = math.inf, ends.mean(axis=1), 1.0
    for sign in (1.0, -1.0):

        def residuals(point: Array, sign: float = sign) -> Array:
            return _finite((sign * speeds(point) - seen) / error)

        rough = (_finite((sign * tried - seen) / error) ** 2).sum(axis=1)
        for start in screened[_apart(unit, rough)]:
            found = _least(residuals, start, ends)
            if found[0] < best[0]:
                best = (*found, sign)
    chi2, point, sign = best
    return Fit(values(point), tuple((sign * speeds(point)).tolist()), chi2, len(names))


def _apart(unit: Array, merit: Array) -> list[int]:
    """The best points that lie apart from better ones: each basin is to be started in."""
    chosen: list[int] = []
    for i in np.argsort(merit):
        if all(np.linalg.norm(unit[i] - unit[j]) > _APART for j in chosen):
            chosen.append(int(i))
        if len(chosen) == _STARTS:
            break
    return chosen


def _finite(off: Array) -> Array:
    return np.where(np.isfinite(off), off, _HOPELESS)


def _least(residuals: Callable[[Array], Array], start: Array, ends: Array) -> tuple[float, Array]:
    found = least_squares(
        residuals, start, bounds=tuple(ends.T), x_scale=ends[:, 1] - ends[:, 0], max_nfev=60
    )
    return 2 * float(found.cost), found.x


def _inner(name: str, value: float) -> float:
    return math.log(value) if name == "k" else value


def _outer(name: str, value: float) -> float:
    return math.exp(float(value)) if name == "k" else float(value)
