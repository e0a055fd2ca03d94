"""Which definitions of J20/J10, units of kappa and signs of (3) are consistent with the averages.

Each hypothesis is fitted to the nine rows with everything else free inside `prototype.BOX`; Table
1's masses and inertias are kept, and all rows have the same sign of the speed, whichever fits
better. Chi-square is in standard errors, half_width/t. A standard error of three runs has only two
degrees of freedom, so the residual chi-square is compared with squares of Student's t: p is the
share of random sets of nine - fitted such squares that exceed it. This is approximate: it assumes
that each fitted unknown accounts for one row.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from scipy.optimize import least_squares
from scipy.stats.qmc import LatinHypercube

from rr_opt.array import Array
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_paper.prototype import ABOUT_P, BOX, DEFINITIONS, RatioDefinition, box_grid, prototype
from rr_paper.publication import COLUMNS, RATIOS, ROWS, RUNS, TABLE_1, Column
from rr_paper.signs import CORRECTED, PRINTED, Signs, steady_cycle

_SCREENED, _STARTS, _SPACING, _SEED = 400, 8, 0.6, 1
"""Screened points; number of the best used as starts for each sign, and their least distance in the
unit box."""
_NO_CYCLE = 100.0
"""Residual of a row that has no steady speed, in standard errors."""
_SAMPLES = 64
"""Samples per half period; enough up to the box's largest amplitude."""
_SETS, _SETS_SEED = 200_000, 5

Question = Literal["ratio", "kappa", "equation"]
QUESTIONS: tuple[Question, ...] = ("ratio", "kappa", "equation")

KAPPA = TABLE_1["kappa"].value
LARGEST_WHEEL = 0.04
"""A wheel radius above what the drawings allow, m: it makes kappa in N m s brake least."""


def predicted(
    robot: Robot, definition: RatioDefinition, amplitude: float, signs: Signs = CORRECTED
) -> Array:
    """Signed speeds of the nine rows, m/s; Table 2 at `amplitude`, rad. NaN where there is none."""
    alpha = np.array([row.amplitude or amplitude for row in ROWS])
    try:
        built = {ratio: definition.build(robot, ratio) for ratio in {row.ratio for row in ROWS}}
    except InputError:
        return np.full(len(ROWS), np.nan)
    robots, period = [built[row.ratio] for row in ROWS], np.array([row.period for row in ROWS])
    # Beyond the singular posture the samples may straddle the poles unnoticed.
    inside = alpha < robot.singular_angle
    with np.errstate(all="ignore"):
        speed = steady_cycle(robots, alpha, period, signs, _SAMPLES).speed
    return np.where(inside, speed, np.nan)


@dataclass(frozen=True)
class RowFit:
    """The best fit to a column.

    values     of the unknowns by name, fixed ones included
    predicted  speeds of the nine rows, m/s, signed so that most are positive
    chi2       of the nine rows; free: number of fitted unknowns
    """

    values: Mapping[str, float]
    predicted: tuple[float, ...]
    chi2: float
    free: int


def fit(
    definition: RatioDefinition,
    column: Column,
    *,
    signs: Signs = CORRECTED,
    fixed: Mapping[str, float] | None = None,
) -> RowFit:
    """Fit the unknowns of BOX that are not fixed, k in its logarithm, to a column."""
    fixed = fixed or {}
    names = [name for name in BOX if name not in fixed]
    ends = np.array([np.log(BOX[name]) if name == "k" else BOX[name] for name in names])
    seen = np.array([row.speed(column) for row in ROWS])
    error = np.array([row.standard_error for row in ROWS])

    def values(point: Array) -> dict[str, float]:
        free = dict(zip(names, point.tolist(), strict=True))
        if "k" in free:
            free["k"] = math.exp(free["k"])
        return {**fixed, **free}

    def speeds(point: Array) -> Array:
        unknowns = values(point)
        amplitude = unknowns.pop("amplitude")
        return predicted(prototype(**unknowns), definition, amplitude, signs)

    unit = LatinHypercube(len(names), rng=_SEED).random(_SCREENED)
    points = ends[:, 0] + unit * (ends[:, 1] - ends[:, 0])
    screened = np.array([speeds(point) for point in points])
    best: tuple[float, Array, float] = math.inf, ends.mean(axis=1), 1.0
    for sign in (1.0, -1.0):

        def residuals(at: Array, sign: float = sign) -> Array:
            off = (sign * at - seen) / error
            return np.where(np.isfinite(off), off, _NO_CYCLE)

        chi2 = (residuals(screened) ** 2).sum(axis=1)
        for start in points[_spread(unit, chi2)]:
            found = least_squares(
                lambda point, residuals=residuals: residuals(speeds(point)),
                start, bounds=tuple(ends.T), x_scale=ends[:, 1] - ends[:, 0], max_nfev=60,
            )  # fmt: skip
            best = min(best, (2 * float(found.cost), found.x, sign), key=lambda one: one[0])
    chi2, point, sign = best
    return RowFit(values(point), tuple((sign * speeds(point)).tolist()), chi2, len(names))


def _spread(unit: Array, chi2: Array) -> list[int]:
    """The best points that are not close to better ones, so that each basin is tried."""
    chosen: list[int] = []
    for i in np.argsort(chi2):
        if all(np.linalg.norm(unit[i] - unit[j]) > _SPACING for j in chosen):
            chosen.append(int(i))
        if len(chosen) == _STARTS:
            break
    return chosen


@dataclass(frozen=True)
class Hypothesis:
    """A hypothesis fitted to one column."""

    question: Question
    name: str
    definition: RatioDefinition
    signs: Signs
    column: Column
    fit: RowFit

    @property
    def at_edge(self) -> bool:
        """Some unknown ended on a side of the box."""
        return any(
            min(abs(self.fit.values[name] - end) for end in ends) < 1e-3 * (ends[1] - ends[0])
            for name, ends in BOX.items()
        )

    @property
    def p(self) -> float:
        """The share of random sets that leave a larger chi-square."""
        return float((_random_chi2(len(ROWS) - self.fit.free) > self.fit.chi2).mean())


@dataclass(frozen=True)
class Unloaded:
    """J20/J10 of Table 1's robot without loads, by one definition.

    low, high  over the box of a1 and a2
    reached    the printed ratios that need no lighter platform 2, somewhere in the box
    """

    definition: RatioDefinition
    low: float
    high: float
    reached: tuple[float, ...]

    @property
    def excluded(self) -> list[float]:
        """The other printed ratios."""
        return [ratio for ratio in RATIOS if ratio not in self.reached]


@dataclass(frozen=True)
class Consistency:
    """All hypotheses; still: chi-square of each column if the robot did not move at all."""

    hypotheses: tuple[Hypothesis, ...]
    unloaded: tuple[Unloaded, ...]
    still: dict[Column, float]

    def of(self, question: Question, column: Column) -> list[Hypothesis]:
        """Those for one question and column."""
        return [one for one in self.hypotheses if (one.question, one.column) == (question, column)]


def audit_hypotheses(progress: Callable[[str], None]) -> Consistency:
    """Fit every hypothesis to both columns; some twenty seconds."""
    posed: list[tuple[Question, str, RatioDefinition, Signs, dict[str, float]]] = [
        *(("ratio", one.name, one, CORRECTED, {}) for one in DEFINITIONS),
        *(("kappa", name, ABOUT_P, CORRECTED, {"k": k}) for name, k in kappas()),
        ("equation", "equation (3) as printed", ABOUT_P, PRINTED, {}),
    ]
    fitted: list[Hypothesis] = []
    for question, name, definition, signs, fixed in posed:
        for column in COLUMNS:
            progress(f"fit {len(fitted) + 1} of {len(posed) * len(COLUMNS)}")
            best = fit(definition, column, signs=signs, fixed=fixed)
            fitted.append(Hypothesis(question, name, definition, signs, column, best))
    still: dict[Column, float] = {
        column: sum((row.speed(column) / row.standard_error) ** 2 for row in ROWS)
        for column in COLUMNS
    }
    return Consistency(tuple(fitted), tuple(_unloaded(one) for one in DEFINITIONS), still)


def kappas() -> tuple[tuple[str, float], ...]:
    """Readings of the printed kappa = 0.25, with the k of one wheel that each gives, N s/m."""
    return (
        (f"{KAPPA:g} N s/m, each wheel's k", KAPPA),
        (f"{KAPPA:g} N s/m, for a pair of wheels", KAPPA / 2),
        (f"{KAPPA:g} N m s with wheels of {1e3 * LARGEST_WHEEL:g} mm", KAPPA / LARGEST_WHEEL**2),
    )


def _unloaded(definition: RatioDefinition) -> Unloaded:
    ratios = [definition.ratio(robot) for robot in box_grid(13)]
    reached = tuple(ratio for ratio in RATIOS if ratio >= min(ratios))
    return Unloaded(definition, min(ratios), max(ratios), reached)


@lru_cache
def _random_chi2(count: int) -> Array:
    draws = np.random.default_rng(_SETS_SEED).standard_t(RUNS - 1, (_SETS, count))
    return (draws**2).sum(axis=1)
