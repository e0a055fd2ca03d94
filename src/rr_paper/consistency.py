"""Which readings of J20/J10, of kappa and of the speed columns the nine averages allow.

What J20/J10 may mean: several readings, each giving platform 2 the inertia it asks for.

The paper varies the ratio by loads on platform 2 and does not say about which points J20 and J10
are taken. Section 2 also has J1 and J2 of its own, in which both platforms and the joint enter.

How near a reading of the paper can come to its nine averages, whatever else is open.

What Table 1 leaves out is fitted within a box: a1 and a2 (c1 and c2 follow from c1 - a1 and
c2 - a2), one half track b and one friction k for all wheels, and Table 2's amplitude. Table 1's
masses and inertias stand. The sign of the speed is one for all rows, whichever fits better.

Chi-square counts in standard errors, half_width/t with t = 4.303 of n = 3 runs. Those are
themselves known from two degrees of freedom only, so its usual thresholds do not hold.

Each is fitted with everything else open (`fit`), and judged by the chi-square that is
left. A standard error of three runs is itself a guess from two degrees of freedom, so what is left
is held against squares of Student's t: p is the share of random sets of nine - fitted such squares
that exceed it. That is rough: it takes each fitted unknown to take up one row.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from types import MappingProxyType
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.optimize import least_squares

from rr_opt.array import Array
from rr_opt.model.ballast import inertia_ratio, with_inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.outcome import InputError
from rr_opt.verify.speeds import model_of
from rr_paper.equation3 import CORRECTED, PRINTED, Signs, steady
from rr_paper.printed import LOADED_RATIOS, RUNS, TABLE_1, TABLE_2, TABLE_3


@dataclass(frozen=True)
class Reading:
    """One meaning of J20/J10.

    ratio  of a robot as it is
    build  (robot, ratio) -> the robot rebuilt; raises InputError where that cannot be
    """

    name: str
    ratio: Callable[[Robot], float]
    build: Callable[[Robot, float], Robot]


def _about_axles(robot: Robot) -> float:
    one, two = robot.platform1, robot.platform2
    return (two.I + two.m * two.a**2) / (one.I + one.m * one.a**2)


def _with_axles(robot: Robot, ratio: float) -> Robot:
    one, two = robot.platform1, robot.platform2
    return _with_inertia(robot, ratio * (one.I + one.m * one.a**2) - two.m * two.a**2)


def _of_section_2(robot: Robot) -> tuple[float, float]:
    """J1 and J2 of section 2 less I20, kg m2: what they are besides it."""
    one, two = robot.platform1, robot.platform2
    return (
        one.I + one.m * one.a**2 + two.m * (two.a**2 + one.c**2 - two.c**2),
        -two.m * (two.c**2 - two.a**2),
    )


def _section_2(robot: Robot) -> float:
    J1, J2 = _of_section_2(robot)
    return (robot.platform2.I + J2) / (robot.platform2.I + J1)


def _with_section_2(robot: Robot, ratio: float) -> Robot:
    J1, J2 = _of_section_2(robot)
    return _with_inertia(robot, (ratio * J1 - J2) / (1 - ratio))


def _with_inertia(robot: Robot, inertia: float) -> Robot:
    if inertia <= 0:
        raise InputError(
            f"The ratio needs I2 = {inertia:.3g} kg m2. It must be positive. Ask for a larger one."
        )
    return replace(robot, platform2=replace(robot.platform2, I=inertia))


READINGS = (
    Reading(
        "about P, by platform 2's inertia",
        lambda robot: inertia_ratio(robot, "joint"),
        lambda robot, ratio: with_inertia_ratio(robot, ratio, "joint"),
    ),
    Reading(
        "about P, by loads of 66 g",
        lambda robot: inertia_ratio(robot, "joint"),
        lambda robot, ratio: with_inertia_ratio(robot, ratio, "joint", "loads"),
    ),
    Reading(
        "about the centres of mass",
        lambda robot: inertia_ratio(robot, "centre"),
        lambda robot, ratio: with_inertia_ratio(robot, ratio, "centre"),
    ),
    Reading("about the axles' centres", _about_axles, _with_axles),
    Reading("J2/J1 of section 2", _section_2, _with_section_2),
)
ABOUT_P = READINGS[0]


ROWS = (*TABLE_2, *TABLE_3)

BOX = MappingProxyType(
    {
        "a1": (-0.03, 0.03),
        "a2": (-0.03, 0.03),
        "b": (0.02, 0.08),
        "k": (0.01, 1.0),
        "amplitude": (0.2, 1.5),
    }
)
"""Where the unknowns may lie: m, m, m, N s/m, rad; k is fitted in its logarithm."""

_SAMPLES = 64


def prototype(a1: float, a2: float, b: float, k: float) -> Robot:
    """Table 1 with these unknowns; h = 20 mm stands for any, as only k matters."""
    h = 0.02
    known = {name: value for name, (value, _) in TABLE_1.items()}
    return Robot(
        Platform(known["m1"], known["I10"], known["c1 - a1"] + a1, a1, b, k * h**2),
        Platform(known["m2"], known["I20"], known["c2 - a2"] + a2, a2, b, k * h**2),
        h,
    )


def predicted(robot: Robot, reading: Reading, amplitude: float, signs: Signs = CORRECTED) -> Array:
    """Signed speeds of the nine rows, m/s; Table 2 at `amplitude`, rad. NaN where there is none."""
    alpha = np.array([row.amplitude or amplitude for row in ROWS])
    try:
        built = {ratio: reading.build(robot, ratio) for ratio in {row.ratio for row in ROWS}}
    except InputError:
        return np.full(len(ROWS), np.nan)
    robots = [built[row.ratio] for row in ROWS]
    if signs is not CORRECTED:
        gaits = [SineGait(float(a), row.period) for a, row in zip(alpha, ROWS, strict=True)]
        return np.array(
            [
                steady(one, gait, signs).speed if gait.peak_angle < one.singular_angle else np.nan
                for one, gait in zip(robots, gaits, strict=True)
            ]
        )
    p = np.array([dynamics_of(one).values(one) for one in robots]).T
    period = np.array([[row.period] for row in ROWS])
    found = model_of(robot).cycles(alpha, np.zeros(len(ROWS)), period, p, _SAMPLES, True)
    inside = alpha < np.array([one.singular_angle for one in robots])
    return np.where(inside & (found.error[:, 0] < 1e-2), found.speed[:, 0], np.nan)


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


Question = Literal["ratio", "kappa", "equation"]
QUESTIONS: tuple[Question, ...] = ("ratio", "kappa", "equation")

KAPPA = TABLE_1["kappa"].value
WIDEST_WHEEL = 0.04
"""A wheel radius, m, larger than the drawings allow: with it kappa in N m s brakes least."""

RATIOS = tuple(sorted({*LOADED_RATIOS, *(row.ratio for row in (*TABLE_2, *TABLE_3))}))
"""Every J20/J10 that the paper prints."""

_SETS, _CONSISTENCY_SEED = 200_000, 5


@dataclass(frozen=True)
class Tried:
    """A reading fitted to one column; p as the module's head says."""

    question: Question
    name: str
    reading: Reading
    signs: Signs
    column: Column
    fit: Fit

    @property
    def p(self) -> float:
        """The share of sets that miss by more."""
        return float((_sets(len(ROWS) - self.fit.free) > self.fit.chi2).mean())


@dataclass(frozen=True)
class Bare:
    """What a reading makes of Table 1's robot without loads.

    low, high  J20/J10 over the box of a1 and a2
    reached    which of the printed ratios need platform 2 to be no lighter than without loads,
               at some a1 and a2 of the box
    """

    reading: Reading
    low: float
    high: float
    reached: tuple[float, ...]


@dataclass(frozen=True)
class Consistency:
    """All that was tried; still: chi-square of each column if the robot did not move at all."""

    tried: tuple[Tried, ...]
    bare: tuple[Bare, ...]
    still: dict[Column, float]

    def of(self, question: Question, column: Column) -> list[Tried]:
        """Those of one question and column."""
        return [one for one in self.tried if (one.question, one.column) == (question, column)]


def audit_readings(progress: Callable[[str], None]) -> Consistency:
    """Fit every reading to both columns; some twenty seconds."""
    asked: list[tuple[Question, str, Reading, Signs, dict[str, float]]] = [
        *(("ratio", one.name, one, CORRECTED, {}) for one in READINGS),
        *(("kappa", name, ABOUT_P, CORRECTED, {"k": k}) for name, k in kappas()),
        ("equation", "equation (3) as printed", ABOUT_P, PRINTED, {}),
    ]
    tried: list[Tried] = []
    for question, name, reading, signs, fixed in asked:
        for column in COLUMNS:
            progress(f"fit {len(tried) + 1} of {len(asked) * len(COLUMNS)}")
            found = fit(reading, column, signs=signs, fixed=fixed)
            tried.append(Tried(question, name, reading, signs, column, found))
    still: dict[Column, float] = {
        column: sum((getattr(row, column) * STUDENT / row.half_width) ** 2 for row in ROWS)
        for column in COLUMNS
    }
    return Consistency(tuple(tried), tuple(_bare(one) for one in READINGS), still)


def kappas() -> tuple[tuple[str, float], ...]:
    """Readings of kappa = 0.25, with the k of one wheel, N s/m, that each gives."""
    return (
        (f"{KAPPA:g} N s/m, each wheel's k", KAPPA),
        (f"{KAPPA:g} N s/m, for a pair of wheels", KAPPA / 2),
        (f"{KAPPA:g} N m s with wheels of {1e3 * WIDEST_WHEEL:g} mm", KAPPA / WIDEST_WHEEL**2),
    )


def stops_in(k: float) -> float:
    """Time in which friction k at four wheels brakes Table 1's masses to 1/e, straight ahead, s."""
    return (TABLE_1["m1"].value + TABLE_1["m2"].value) / (4 * k)


def wheel_for(k: float) -> float:
    """The wheel radius, m, at which kappa = 0.25 mN m s gives this k."""
    return math.sqrt(1e-3 * KAPPA / k)


def _bare(reading: Reading) -> Bare:
    robots = [
        prototype(float(a1), float(a2), 0.03, 0.1)
        for a1 in np.linspace(*BOX["a1"], 13)
        for a2 in np.linspace(*BOX["a2"], 13)
    ]
    ratios = [reading.ratio(one) for one in robots]
    reached = tuple(ratio for ratio in RATIOS if ratio >= min(ratios))
    return Bare(reading, min(ratios), max(ratios), reached)


@lru_cache
def _sets(count: int) -> NDArray[np.float64]:
    draws = np.random.default_rng(_CONSISTENCY_SEED).standard_t(RUNS - 1, (_SETS, count))
    return (draws**2).sum(axis=1)
