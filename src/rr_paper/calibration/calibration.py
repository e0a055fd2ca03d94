"""What the nine averages say of the paper's robot, and of the models."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.files.problem_file import read_problem
from rr_paper.calibration.comparison import Assessment, assess
from rr_paper.calibration.coverage import Coverage, coverage
from rr_paper.calibration.fit import Effort, Estimator, Fit, estimator
from rr_paper.calibration.likelihood import Data, measured
from rr_paper.calibration.models import DRY, MODELS, READINGS, VISCOUS, Model, Reading
from rr_paper.calibration.posterior import Posterior, sample
from rr_paper.calibration.profiles import Profile, profiles
from rr_paper.calibration.unknowns import UNKNOWNS, Unknown, shares
from rr_paper.publication import COLUMNS, Column

_CHEAP = Effort(log2_size=15, slices=12, values=25, starts=2, steps=20, sets=200)
_MEDIUM = Effort(log2_size=13, slices=8, values=0, starts=0, steps=15, sets=0)
_EXPENSIVE = Effort(log2_size=12, slices=5, values=11, starts=2, steps=9, sets=40)

CHAINS, SWEEPS = 100, 2400
"""Of the posterior sample of the viscous model."""
COVERAGE_SETS = 100
"""Simulated data sets on which the coverage of the intervals is counted."""

REDUCED = {VISCOUS: {"log2_size": 14}, DRY: {"log2_size": 11, "slices": 3}}
"""What is reduced for the other readings of J20/J10, by model."""

_PINNED = 0.25
"""Share of the box's own 95 % width below which an unknown counts as pinned down."""

ASSUMED = ("a1", "a2", "b", "k")
"""The unknowns for which the shipped robot file assumes a value."""


def effort(model: Model) -> Effort:
    """For a model."""
    if model.cost > 10:
        return _EXPENSIVE
    return _MEDIUM if model.cost > 2 else _CHEAP


@dataclass(frozen=True)
class Shipped:
    """The shipped robot's values by name, SI; rise of the deviance above the least, at the best
    amplitude (rad) of Table 2."""

    values: dict[str, float]
    rise: float
    amplitude: float


@dataclass(frozen=True)
class Alternative:
    """A model's best fit for another reading of J20/J10; of the viscous model also where the
    shipped robot's values stand."""

    reading: Reading
    model: Model
    column: Column
    student: Fit
    shipped: Shipped | None


@dataclass(frozen=True)
class Interval:
    """95 % intervals of an unknown, SI: the posterior's with its median, and the profiles' by
    Student's t and by the normal distribution.

    share  width of the posterior's, as a share of the box's own
    """

    unknown: Unknown
    column: Column
    posterior: tuple[float, float]
    median: float
    profile: Profile
    normal: Profile
    share: float

    @property
    def verdict(self) -> str:
        """How far the rows have narrowed the box: not at all if the profile leaves it whole."""
        if self.profile.low <= 0 and self.profile.high >= 1:
            return "not identifiable"
        return "pinned down" if self.share < _PINNED else "narrowed"

    def profile_text(self, profile: Profile) -> str:
        """A profile's interval; `open` where the box ends it."""
        below, above = profile.low <= 0, profile.high >= 1
        if below and above:
            return "whole box"
        open_side = " (open below)" if below else " (open above)" if above else ""
        return self.unknown.span(profile.ends(self.unknown)) + open_side

    def contains(self, value: float) -> bool:
        """Whether a value is in the posterior's interval and in the profile's by Student's t."""
        both = (self.posterior, self.profile.ends(self.unknown))
        return all(low - 1e-12 <= value <= high + 1e-12 for low, high in both)


@dataclass(frozen=True)
class Calibration:
    """What the nine rows say.

    assessments      by model and column
    posterior        of the viscous model, by column
    normal_profiles  its profiles by the normal distribution, by column
    shipped          the shipped robot's values, by column
    coverage         on data of known robots
    alternatives     other readings of J20/J10
    """

    assessments: Mapping[tuple[str, Column], Assessment]
    posterior: Mapping[Column, Posterior]
    normal_profiles: Mapping[Column, tuple[Profile, ...]]
    shipped: Mapping[Column, Shipped]
    coverage: Coverage
    alternatives: tuple[Alternative, ...]

    def intervals(self) -> list[Interval]:
        """Of every unknown of the viscous model, for each column."""
        found = []
        for column in COLUMNS:
            low, median, high = self.posterior[column].quantiles()
            student = self.assessments[VISCOUS, column].profiles
            for i, name in enumerate(MODELS[VISCOUS].unknowns):
                unknown = UNKNOWNS[name]
                ends = unknown.value([low[i], median[i], high[i]]).tolist()
                share = float(high[i] - low[i]) / 0.95
                normal = self.normal_profiles[column][i]
                found.append(
                    Interval(
                        unknown, column, (ends[0], ends[2]), ends[1], student[i], normal, share
                    )
                )
        return found

    def shipped_outside(self, column: Column) -> list[str]:
        """Symbols of the unknowns for which the shipped robot's value is outside its interval."""
        values = shipped_values()
        return [
            one.unknown.symbol
            for one in self.intervals()
            if one.column == column
            and one.unknown.name in values
            and not one.contains(values[one.unknown.name])
        ]

    def draws(self, column: Column, name: str) -> Array:
        """Of one unknown of the viscous model, as shares of its box."""
        return self.posterior[column].points[:, MODELS[VISCOUS].unknowns.index(name)]

    def conditional(
        self, column: Column, known: str, value: float, within: float, wanted: str
    ) -> tuple[float, float]:
        """95 % interval of one unknown (SI), were another known to be value +- within (SI)."""
        near = np.abs(UNKNOWNS[known].value(self.draws(column, known)) - value) <= within
        if not near.any():
            return float("nan"), float("nan")
        ends = np.quantile(self.draws(column, wanted)[near], [0.025, 0.975])
        low, high = UNKNOWNS[wanted].value(ends).tolist()
        return low, high

    def correlation(self, column: Column, one: str, other: str) -> float:
        """Of two unknowns in the posterior, as shares of their boxes."""
        return float(np.corrcoef(self.draws(column, one), self.draws(column, other))[0, 1])


def calibrate(progress: Callable[[str], None]) -> Calibration:
    """All of it, in two or three minutes; the seeds are fixed, so results are reproducible.

    progress(`WHAT 3 of 8`) is called often; an exception that it raises ends the work.
    """
    count = _Count(progress, len(MODELS) * len(COLUMNS) + len(COLUMNS) + 2)
    viscous, assessments = _assess_all(count)
    posterior: dict[Column, Posterior] = {}
    for column in COLUMNS:
        count.next(f"posterior, {column} column")
        posterior[column] = sample(
            viscous, measured(column), chains=CHAINS, sweeps=SWEEPS, tick=count.tick
        )
    count.next("coverage")
    covered = coverage(
        viscous, posterior["mean"], measured("mean"), sets=COVERAGE_SETS, tick=count.tick
    )
    count.next("other readings of J20/J10")
    normal: dict[Column, tuple[Profile, ...]] = {}
    shipped: dict[Column, Shipped] = {}
    for column in COLUMNS:
        data, least = measured(column), assessments[VISCOUS, column].student.deviance
        normal[column] = profiles(viscous, data, range(viscous.points.shape[1]), "normal")
        shipped[column] = _shipped(viscous, data, least)
    return Calibration(assessments, posterior, normal, shipped, covered, _alternatives(count.tick))


class _Count:
    """Progress of work in a known number of parts."""

    def __init__(self, progress: Callable[[str], None], total: int):
        self._progress, self._total, self._done, self._words = progress, total, 0, ""

    def next(self, words: str) -> None:
        """The next part begins."""
        self._done, self._words = self._done + 1, words
        self.tick()

    def tick(self) -> None:
        """Still at it."""
        self._progress(f"{self._words} {self._done} of {self._total}")


def _estimator(model: Model, reading: Reading, work: Effort, tick: Callable[[], None]) -> Estimator:
    return estimator(lambda points: model(points, reading), len(model.unknowns), work, tick)


def _assess_all(count: _Count) -> tuple[Estimator, dict[tuple[str, Column], Assessment]]:
    """The viscous model's estimator, and every model's assessments."""
    estimators: dict[str, Estimator] = {}
    assessments: dict[tuple[str, Column], Assessment] = {}
    for name, model in MODELS.items():
        for column in COLUMNS:
            count.next(f"{name}, {column} column")
            if name not in estimators:
                estimators[name] = _estimator(model, READINGS[0], effort(model), count.tick)
            inner = None
            if name != VISCOUS:
                inner = estimators[VISCOUS], assessments[VISCOUS, column]
            assessments[name, column] = assess(estimators[name], model, column, inner)
    return estimators[VISCOUS], assessments


def _alternatives(tick: Callable[[], None]) -> tuple[Alternative, ...]:
    """The viscous model, and that with dry friction, for every other reading of J20/J10."""
    found = []
    for reading in READINGS[1:]:
        for name, reduced in REDUCED.items():
            model = MODELS[name]
            here = _estimator(model, reading, replace(effort(model), **reduced), tick)
            for column in COLUMNS:
                data = measured(column)
                best = here.fit(data)
                shipped = _shipped(here, data, best.deviance) if name == VISCOUS else None
                found.append(Alternative(reading, model, column, best, shipped))
    return tuple(found)


def shipped_values() -> dict[str, float]:
    """a1, a2, b (m) and k (N s/m) of the shipped robot file."""
    robot = read_problem(None).robot
    one, two = robot.platform1, robot.platform2
    if (one.b, robot.k1) != (two.b, robot.k2):
        raise ValueError("the shipped robot's platforms differ in b or k; the calibration's do not")
    return {"a1": one.a, "a2": two.a, "b": one.b, "k": robot.k1}


def _shipped(viscous: Estimator, data: Data, least: float) -> Shipped:
    """least: the viscous model's least deviance."""
    values = shipped_values()
    amplitude = UNKNOWNS["amplitude"].value(np.linspace(0, 1, 241))
    points = {name: np.full(len(amplitude), value) for name, value in values.items()}
    points["amplitude"] = amplitude
    deviance = data.deviance(viscous.predict(shares((*ASSUMED, "amplitude"), points)))
    best = int(deviance.argmin())
    return Shipped(values, float(deviance[best] - least), float(amplitude[best]))
