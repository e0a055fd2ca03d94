"""The calibration: what the nine averages imply about the paper's robot, and about the models."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_paper.calibration.comparison import Assessment, assess, coverage
from rr_paper.calibration.fit import Data, Effort, Estimator, estimator, measured
from rr_paper.calibration.intervals import Posterior, Profile, profiles, sample
from rr_paper.calibration.models import (
    DRY,
    MODELS,
    READINGS,
    UNKNOWNS,
    VISCOUS,
    Model,
    Reading,
    shares,
)
from rr_paper.calibration.report import ASSUMED, Alternative, Calibration, Shipped, shipped_values
from rr_paper.publication import COLUMNS, Column

_CHEAP = Effort(log2_size=15, slices=12, values=25, starts=2, steps=20, sets=200)
_MEDIUM = Effort(log2_size=13, slices=8, values=0, starts=0, steps=15, sets=0)
_EXPENSIVE = Effort(log2_size=12, slices=5, values=11, starts=2, steps=9, sets=40)

CHAINS, SWEEPS = 100, 2400
"""Of the posterior sample of the viscous model."""
COVERAGE_SETS = 100
"""Simulated data sets on which the coverage of the intervals is counted."""

REDUCED = {VISCOUS: {"log2_size": 14}, DRY: {"log2_size": 11, "slices": 3}}
"""Reduced effort for the other readings of J20/J10, by model."""


def effort(model: Model) -> Effort:
    """The effort for a model."""
    if model.cost > 10:
        return _EXPENSIVE
    return _MEDIUM if model.cost > 2 else _CHEAP


def calibrate(progress: Callable[[str], None]) -> Calibration:
    """All of it, in two or three minutes; the seeds are fixed, so results are reproducible.

    progress(`WHAT 3 of 8`) is called often; an exception that it raises ends the work.
    """
    work = _Work(progress, len(MODELS) * len(COLUMNS) + len(COLUMNS) + 2)
    viscous, assessments = _assess_all(work)
    posterior: dict[Column, Posterior] = {}
    for column in COLUMNS:
        work.begin(f"posterior, {column} column")
        posterior[column] = sample(viscous, measured(column), chains=CHAINS, sweeps=SWEEPS)
    work.begin("coverage")
    covered = coverage(viscous, posterior["mean"], measured("mean"), COVERAGE_SETS)
    work.begin("other readings of J20/J10")
    normal: dict[Column, tuple[Profile, ...]] = {
        column: profiles(viscous, measured(column), range(viscous.points.shape[1]), "normal")
        for column in COLUMNS
    }
    shipped: dict[Column, Shipped] = {
        column: _shipped(viscous, measured(column), assessments[VISCOUS, column].student.deviance)
        for column in COLUMNS
    }
    return Calibration(assessments, posterior, normal, shipped, covered, _alternatives(work))


@dataclass
class _Work:
    """A known number of parts, whose progress is reported whenever a model is evaluated."""

    progress: Callable[[str], None]
    total: int
    done: int = 0
    words: str = ""

    def begin(self, words: str) -> None:
        """Start the next part."""
        self.done, self.words = self.done + 1, words
        self.report()

    def report(self) -> None:
        """Report the part."""
        self.progress(f"{self.words} {self.done} of {self.total}")

    def estimator(self, model: Model, reading: Reading, effort: Effort) -> Estimator:
        """The estimator of a model."""

        def signed(points: Array) -> Array:
            self.report()
            return model(points, reading)

        return estimator(signed, len(model.unknowns), effort)


def _assess_all(work: _Work) -> tuple[Estimator, dict[tuple[str, Column], Assessment]]:
    """The viscous model's estimator, and every model's assessments."""
    estimators: dict[str, Estimator] = {}
    assessments: dict[tuple[str, Column], Assessment] = {}
    for name, model in MODELS.items():
        for column in COLUMNS:
            work.begin(f"{name}, {column} column")
            if name not in estimators:
                estimators[name] = work.estimator(model, READINGS[0], effort(model))
            inner = None
            if name != VISCOUS:
                inner = estimators[VISCOUS], assessments[VISCOUS, column]
            assessments[name, column] = assess(estimators[name], model, column, inner)
    return estimators[VISCOUS], assessments


def _alternatives(work: _Work) -> tuple[Alternative, ...]:
    """The viscous model, and that with dry friction, for every other reading of J20/J10."""
    found = []
    for reading in READINGS[1:]:
        for name, reduced in REDUCED.items():
            model = MODELS[name]
            here = work.estimator(model, reading, replace(effort(model), **reduced))
            for column in COLUMNS:
                data = measured(column)
                best = here.fit(data)
                shipped = _shipped(here, data, best.deviance) if name == VISCOUS else None
                found.append(Alternative(reading, model, column, best, shipped))
    return tuple(found)


def _shipped(viscous: Estimator, data: Data, least: float) -> Shipped:
    """least: the viscous model's least deviance."""
    values = shipped_values()
    amplitude = UNKNOWNS["amplitude"].value(np.linspace(0, 1, 241))
    points = {name: np.full(len(amplitude), value) for name, value in values.items()}
    points["amplitude"] = amplitude
    deviance = data.deviance(viscous.predict(shares((*ASSUMED, "amplitude"), points)))
    best = int(deviance.argmin())
    return Shipped(values, float(deviance[best] - least), float(amplitude[best]))
