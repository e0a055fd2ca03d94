"""The calibration as a whole: every model on both columns, what is known of each unknown, and
whether the intervals keep their word."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from rr_opt.paper.calibration.coverage import Coverage, coverage
from rr_opt.paper.calibration.effort import CHAINS, COVERAGE_SETS, OTHERS, SWEEPS, effort
from rr_opt.paper.calibration.fit import Fit
from rr_opt.paper.calibration.held import Held, Searched, hold, searched
from rr_opt.paper.calibration.measured import COLUMNS, Column, measured
from rr_opt.paper.calibration.models import MODELS, Model
from rr_opt.paper.calibration.posterior import Posterior, sample
from rr_opt.paper.calibration.profile import Profile
from rr_opt.paper.calibration.robots import READINGS, Reading
from rr_opt.paper.calibration.shipped import Shipped, shipped

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
