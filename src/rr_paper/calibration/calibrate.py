"""Do the intervals keep their word? Nine rows are made by robots that are known, and counted.

The robots are draws from the posterior, so they are such as the paper's may have been. A 95 %
interval that is honest holds the truth 95 times in a hundred.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import chi2

from rr_opt.array import Array
from rr_opt.files.problem_file import read_problem
from rr_paper.calibration.compare import Simulated, nearest, refits, simulated
from rr_paper.calibration.fit import CHAINS, COVERAGE_SETS, OTHERS, SWEEPS, Fit, Library, effort
from rr_paper.calibration.held import Held, Searched, hold, searched
from rr_paper.calibration.models import (
    COLUMNS,
    MODELS,
    READINGS,
    UNKNOWNS,
    Column,
    Law,
    Measured,
    Model,
    Reading,
    measured,
    one_way,
    row_deviance,
    shares,
)
from rr_paper.calibration.posterior import Posterior, evolve, sample, weights
from rr_paper.calibration.profile import LEVEL, Profile

_STEPS = 10
_CHAINS, _SWEEPS = 24, 160
"""Of each set's own posterior."""


@dataclass(frozen=True)
class Coverage:
    """Shares of data sets whose 95 % interval holds the truth, one number for each unknown.

    sets       how many
    posterior  the middle 95 % of the posterior
    profile    the profile interval, by each law
    needed     the rise of the deviance that 95 % of the truths stay below, Student's law; 3.84
               if the theorem for many data held
    """

    sets: int
    posterior: Array
    profile: dict[Law, Array]
    needed: Array


def coverage(
    predict: Callable[[Array], Array],
    known: Library,
    drawn: Posterior,
    data: Measured,
    *,
    sets: int,
    tick: Callable[[], None],
) -> Coverage:
    """predict gives signed speeds."""
    draw = np.random.default_rng(4)
    truth = drawn.points[draw.choice(len(drawn.points), sets, replace=False)]
    made = simulated(one_way(predict(truth)), data, draw)
    rises = {}
    for law in ("student", "normal"):
        tick()
        rises[law] = _rises(predict, known, truth, made, law)
    return Coverage(
        sets,
        _posterior_coverage(predict, known, truth, made, draw, tick),
        {law: (rise <= LEVEL).mean(axis=0) for law, rise in rises.items()},
        np.quantile(rises["student"], 0.95, axis=0),
    )


def _rises(
    predict: Callable[[Array], Array], known: Library, truth: Array, made: Simulated, law: Law
) -> Array:
    """The deviance with each unknown held at its truth, above the least, (K, unknowns)."""
    starts = [truth, nearest(known, made, law)]
    free = refits(predict, made, starts, law=law, steps=_STEPS)
    rises = []
    for unknown in range(truth.shape[1]):
        held = [start.copy() for start in starts]
        for start in held:
            start[:, unknown] = truth[:, unknown]
        rises.append(refits(predict, made, held, law=law, steps=_STEPS, fixed=unknown))
    # A fit that holds an unknown may find a valley that the free one missed.
    least = np.minimum(free, np.min(rises, axis=0))
    return np.array(rises).T - least[:, None]


def _posterior_coverage(
    predict: Callable[[Array], Array],
    known: Library,
    truth: Array,
    made: Simulated,
    draw: np.random.Generator,
    tick: Callable[[], None],
) -> Array:
    """Share of the truths inside the middle 95 % of each set's posterior, (unknowns,)."""
    start = []
    for i in range(len(truth)):
        chances = weights(known.deviance(made.one(i)))
        start.append(known.points[draw.choice(len(chances), _CHAINS, p=chances)])
    data = Measured(made.speed, made.error)
    kept = evolve(predict, np.array(start), data, _SWEEPS, draw, tick)
    below = (kept <= truth[None, :, None, :]).mean(axis=(0, 2))
    return ((below >= 0.025) & (below <= 0.975)).mean(axis=0)


ASSUMED = ("a1", "a2", "b", "k")
"""What the shipped file assumes of the unknowns."""

JOINT_LEVEL = float(chi2.ppf(0.95, len(ASSUMED)))
"""9.49: by how much the deviance of all four together may rise, if four were many data."""


@dataclass(frozen=True)
class Shipped:
    """values by name, SI; rise of the deviance above the least, at the best amplitude (rad)."""

    values: dict[str, float]
    rise: float
    amplitude: float


def shipped_values() -> dict[str, float]:
    """a1, a2, b (m) and k (N s/m) of the shipped robot file."""
    robot = read_problem(None).robot
    one, two = robot.platform1, robot.platform2
    if (one.b, robot.k1) != (two.b, robot.k2):
        raise ValueError("the shipped robot's platforms differ in b or k; the calibration's do not")
    return {"a1": one.a, "a2": two.a, "b": one.b, "k": robot.k1}


def shipped(predict: Callable[[Array], Array], data: Measured, least: float) -> Shipped:
    """predict: the viscous model's signed speeds; least: its least deviance."""
    values = shipped_values()
    amplitude = UNKNOWNS["amplitude"].value(np.linspace(0, 1, 241))
    points = {name: np.full(len(amplitude), value) for name, value in values.items()}
    points["amplitude"] = amplitude
    speeds = one_way(predict(shares((*ASSUMED, "amplitude"), points)))
    deviance = row_deviance((speeds - data.speed) / data.error, "student").sum(axis=1)
    best = int(deviance.argmin())
    return Shipped(values, float(deviance[best] - least), float(amplitude[best]))


Progress = Callable[[str], None]

_FIRST = "viscous"
"""The model whose unknowns are estimated, and against which the others are held."""


@dataclass(frozen=True)
class Alternative:
    """A model's best fit where J20/J10 is read in another way; of the viscous model also where
    the shipped robot's values stand."""

    reading: Reading
    model: Model
    column: Column
    student: Fit
    shipped: Shipped | None


@dataclass(frozen=True)
class Calibration:
    """What the nine rows say.

    held             by model and column
    posterior        of the viscous model, by column
    normal_profiles  its profiles by the normal law, by column
    shipped          the shipped robot's values, by column
    coverage         on data made by known robots
    alternatives     other readings of J20/J10
    """

    held: Mapping[tuple[str, Column], Held]
    posterior: Mapping[Column, Posterior]
    normal_profiles: Mapping[Column, tuple[Profile, ...]]
    shipped: Mapping[Column, Shipped]
    coverage: Coverage
    alternatives: tuple[Alternative, ...]


def calibrate(progress: Progress) -> Calibration:
    """All of it, in a minute or two; the seeds are fixed, so that it comes out the same again.

    progress(`WHAT 3 of 8`) is called often; what it raises ends the work.
    """
    count = Counted(progress, len(MODELS) * len(COLUMNS) + len(COLUMNS) + 2)
    viscous, held = _all_models(count)
    posterior: dict[Column, Posterior] = {}
    for column in COLUMNS:
        count.next(f"posterior, {column} column")
        posterior[column] = sample(
            viscous.predict, viscous.known, measured(column),
            chains=CHAINS, sweeps=SWEEPS, tick=count.tick,
        )  # fmt: skip
    count.next("coverage")
    kept = coverage(
        viscous.predict, viscous.known, posterior["mean"], measured("mean"),
        sets=COVERAGE_SETS, tick=count.tick,
    )  # fmt: skip
    count.next("other readings of J20/J10")
    return Calibration(
        held,
        posterior,
        {column: viscous.profiles(column, "normal") for column in COLUMNS},
        {
            column: shipped(
                viscous.predict, measured(column), held[_FIRST, column].student.deviance
            )
            for column in COLUMNS
        },
        kept,
        _alternatives(count.tick),
    )


class Counted:
    """Progress of work in so many parts."""

    def __init__(self, progress: Progress, total: int):
        self._progress, self._total, self._done, self._words = progress, total, 0, ""

    def next(self, words: str) -> None:
        """The next part begins."""
        self._done, self._words = self._done + 1, words
        self.tick()

    def tick(self) -> None:
        """Still at it."""
        self._progress(f"{self._words} {self._done} of {self._total}")


def _all_models(count: Counted) -> tuple[Searched, dict[tuple[str, Column], Held]]:
    held: dict[tuple[str, Column], Held] = {}
    viscous: Searched | None = None
    for model in MODELS.values():
        one: Searched | None = None
        for column in COLUMNS:
            count.next(f"{model.name}, {column} column")
            if one is None:
                one = searched(model, READINGS[0], effort(model), count.tick)
            known = (viscous, held[_FIRST, column]) if viscous else None
            held[model.name, column] = hold(one, column, known)
        viscous = viscous or one
    if viscous is None:
        raise ValueError("no model to hold")
    return viscous, held


def _alternatives(tick: Callable[[], None]) -> tuple[Alternative, ...]:
    """The viscous model, and that with dry friction, under every other reading of J20/J10."""
    found = []
    for reading in READINGS[1:]:
        for name in (_FIRST, "viscous+dry"):
            model = MODELS[name]
            work = replace(effort(model), **OTHERS[name])
            one = searched(model, reading, work, tick)
            for column in COLUMNS:
                best, stands = one.fit(column, "student"), None
                if name == _FIRST:
                    stands = shipped(one.predict, measured(column), best.deviance)
                found.append(Alternative(reading, model, column, best, stands))
    return tuple(found)
