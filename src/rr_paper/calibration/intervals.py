"""What is known of each unknown of the viscous model, in three ways, and in a word."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_paper.calibration.calibrate import Calibration
from rr_paper.calibration.models import COLUMNS, MODELS, UNKNOWNS, Column, Unknown
from rr_paper.calibration.profile import Profile

_PINNED = 0.25
"""Share of the box's own 95 % width below which the rows have pinned an unknown down."""


@dataclass(frozen=True)
class Interval:
    """95 % intervals of an unknown, SI: the posterior's, its median, and the profiles'.

    left  width of the posterior's as a share of the box's own, in the box's measure
    """

    unknown: Unknown
    column: Column
    posterior: tuple[float, float]
    median: float
    profile: Profile
    normal: Profile
    left: float

    @property
    def word(self) -> str:
        """How far the rows have narrowed the box: not at all if the profile leaves it whole."""
        if self.profile.low <= 0 and self.profile.high >= 1:
            return "not identifiable"
        return "pinned down" if self.left < _PINNED else "narrowed"

    def of(self, profile: Profile) -> tuple[float, float]:
        """A profile's interval, SI."""
        return ends_of(self.unknown, profile)

    def holds(self, value: float) -> bool:
        """Whether a value lies inside the posterior's interval and Student's profile's."""
        both = (self.posterior, self.of(self.profile))
        return all(low - 1e-12 <= value <= high + 1e-12 for low, high in both)


def ends_of(unknown: Unknown, profile: Profile) -> tuple[float, float]:
    """A profile's interval, SI."""
    low, high = unknown.value([profile.low, profile.high])
    return float(low), float(high)


def intervals(found: Calibration) -> list[Interval]:
    """Of every unknown of the viscous model, for each column."""
    told = []
    for column in COLUMNS:
        low, median, high = found.posterior[column].quantiles()
        held = found.held["viscous", column].profiles
        for i, name in enumerate(MODELS["viscous"].unknowns):
            unknown = UNKNOWNS[name]
            ends = [float(unknown.value(share)) for share in (low[i], median[i], high[i])]
            left = float(high[i] - low[i]) / 0.95
            told.append(
                Interval(
                    unknown, column, (ends[0], ends[2]), ends[1],
                    held[i], found.normal_profiles[column][i], left,
                )
            )  # fmt: skip
    return told


def given(
    found: Calibration, column: Column, known: str, value: float, within: float, wanted: str
) -> tuple[float, float]:
    """95 % of one unknown (SI) were another known to be value +- within (SI)."""
    names = MODELS["viscous"].unknowns
    points = found.posterior[column].points
    near = np.abs(UNKNOWNS[known].value(points[:, names.index(known)]) - value) <= within
    if not near.any():
        return float("nan"), float("nan")
    shares = np.quantile(points[near, names.index(wanted)], [0.025, 0.975])
    low, high = UNKNOWNS[wanted].value(shares)
    return float(low), float(high)


def correlation(found: Calibration, column: Column, one: str, other: str) -> float:
    """Of two unknowns in the posterior, each in its box's measure."""
    names = MODELS["viscous"].unknowns
    points = found.posterior[column].points
    return float(np.corrcoef(points[:, names.index(one)], points[:, names.index(other)])[0, 1])
