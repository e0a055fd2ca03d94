"""The results of a calibration: models compared, intervals of the unknowns and shipped values."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.files.problem_file import read_problem
from rr_paper.calibration.comparison import Assessment, Coverage
from rr_paper.calibration.fit import Fit
from rr_paper.calibration.intervals import Posterior, Profile
from rr_paper.calibration.models import MODELS, UNKNOWNS, VISCOUS, Model, Reading, Unknown
from rr_paper.publication import COLUMNS, Column

_PINNED = 0.25
"""Width relative to the box's 95 % width below which an unknown is well determined."""

ASSUMED = ("a1", "a2", "b", "k")
"""The unknowns for which the shipped robot file assumes a value."""


def shipped_values() -> dict[str, float]:
    """a1, a2, b (m) and k (N s/m) of the shipped robot file."""
    robot = read_problem(None).robot
    one, two = robot.platform1, robot.platform2
    if (one.b, robot.k1) != (two.b, robot.k2):
        raise ValueError("the shipped robot's platforms differ in b or k; the calibration's do not")
    return {"a1": one.a, "a2": two.a, "b": one.b, "k": robot.k1}


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


@dataclass(frozen=True, repr=False)
class Findings:
    """The results from the nine rows.

    assessments      by model and column
    posterior        of the viscous model, by column
    normal_profiles  its profiles by the normal distribution, by column
    shipped          the shipped robot's values, by column
    coverage         on simulated data of known robots
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
        """95 % interval of one unknown (SI), if another were known to be value +- within (SI)."""
        near = np.abs(UNKNOWNS[known].value(self.draws(column, known)) - value) <= within
        if not near.any():
            return float("nan"), float("nan")
        ends = np.quantile(self.draws(column, wanted)[near], [0.025, 0.975])
        low, high = UNKNOWNS[wanted].value(ends).tolist()
        return low, high

    def correlation(self, column: Column, one: str, other: str) -> float:
        """Of two unknowns in the posterior, as shares of their boxes."""
        return float(np.corrcoef(self.draws(column, one), self.draws(column, other))[0, 1])
