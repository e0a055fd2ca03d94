"""The fastest turn: a fastest gait with the arc it drives and the check of its circle."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from rr_opt.design.turn import Arc
from rr_opt.design.turn_target import Target
from rr_opt.formatting import direction_text, number, side_text, with_unit
from rr_opt.model.problem import ANY
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Check
from rr_opt.verify.replay import LARGEST, PERIODS, CircleCheck


@dataclass(frozen=True, repr=False)
class FastestTurn(FastestGait):
    """The fastest gait that makes a turn: as FastestGait, and

    target   what was asked
    opened   whether the problem fixed the offset, which a turn needs, and it was freed
    arc      heading, curvature, time and length of the turn; None where there is no gait
    circle   whether the robot stays on the circle, and comes to it from rest; None likewise
    """

    REPORT = "rr_opt.report.turn"

    target: Target = field(default_factory=Target)
    opened: bool = False
    arc: Arc | None = None
    circle: CircleCheck | None = None

    @property
    def radius(self) -> float | None:
        """Of the circle, m, positive, inf for a straight line; None if there is no gait."""
        if self.arc is None:
            return None
        return abs(1 / self.arc.curvature) if self.arc.curvature else math.inf

    @property
    def turn_prices(self) -> dict[str, float]:
        """Shadow prices of what was asked of the turn, m/s of |speed| per SI unit."""
        best, turn = self.optimum.best, self.problem.turn
        if best is None or turn is None:
            return {}
        names = ("curvature", "yaw_rate", "heading")
        return {name: best.prices[name] for name in names if getattr(turn, name) != ANY}

    @property
    def checks(self) -> list[Check]:
        """Those of any fastest gait, and the circle's."""
        return super().checks + (_circle_checks(self.circle) if self.circle else [])

    @property
    def headline(self) -> str:
        """The result in a phrase; empty if nothing was confirmed."""
        arc = self.arc
        if arc is None or self.radius is None or self.status is not Status.OPTIMAL:
            return ""
        return (
            f"The fastest turn found goes {direction_text(arc.speed)} and to the "
            f"{side_text(arc.curvature)} round {with_unit(self.radius, 'm')} at "
            f"{1e3 * abs(arc.speed):.1f} mm/s"
        )

    @property
    def _subject(self) -> str:
        arc = self.arc
        if arc is None or self.radius is None:
            return super()._subject
        return (
            f"The fastest turn found goes {direction_text(arc.speed)} and to the "
            f"{side_text(arc.curvature)}, round a circle of radius {with_unit(self.radius, 'm')},"
        )

    @property
    def remarks(self) -> list[str]:
        """What else there is to know of the gait, in sentences."""
        if not self.opened or self.arc is None:
            return super().remarks
        bounds = self.problem.gait.offset
        return [
            *super().remarks,
            "The problem fixes the offset, which a turn needs: it was freed within the limits, "
            f"{number(bounds.low)} to {number(bounds.high)} rad.",
        ]


def _circle_checks(circle: CircleCheck) -> list[Check]:
    """Whether P stays on the circle, and whether a start from rest converges to it."""
    tail = f"(at most {LARGEST:.0e} allowed)."
    start = circle.transient
    ahead = "behind" if start.lost >= 0 else "ahead of"
    return [
        Check(
            max(circle.ends, circle.mean) <= LARGEST,
            f"{PERIODS} periods by CVODES: P deviates from the circle by {circle.ends:.1e} of "
            f"the radius, and the mean circle's radius differs by {circle.mean:.1e} "
            f"{tail}",
        ),
        Check(
            circle.rest <= LARGEST,
            f"From rest, after {circle.periods} periods by CVODES: the radius differs by "
            f"{circle.rest:.1e} {tail} The deviation falls to 1/e in "
            f"{with_unit(start.constant, 's')}, and the robot stays "
            f"{with_unit(abs(start.lost), 'm')} {ahead} one that is steady from the start.",
        ),
    ]
