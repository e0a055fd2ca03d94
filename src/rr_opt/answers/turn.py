"""The answer to a turn: an answer as any other, with the arc and the check of the circle."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from rr_opt.answers.quantities import direction_text, number, with_unit
from rr_opt.answers.speed import Answer, Check
from rr_opt.design.turn.fastest_turn import Arc
from rr_opt.design.turn.target import Target
from rr_opt.outcome import Status
from rr_opt.verify.turn.circle import LARGEST, PERIODS, CircleCheck


@dataclass(frozen=True)
class TurnAnswer(Answer):
    """What `turn` has to tell.

    target   what was asked
    opened   the problem fixed the offset, and it was opened
    arc      None where there is no gait
    circle   None where there is no gait to check
    """

    target: Target = field(default_factory=Target)
    opened: bool = False
    arc: Arc | None = None
    circle: CircleCheck | None = None

    @property
    def checks(self) -> list[Check]:
        """Those of any answer, and the circle's."""
        checks = super().checks
        if self.circle:
            checks += circle_checks(self.circle)
        return checks

    @property
    def headline(self) -> str:
        """The turn that was found."""
        arc = self.arc
        if arc is None or not super().headline:
            return ""
        return (
            f"The fastest turn found goes {direction_text(arc.speed)} and to the "
            f"{side(arc.curvature)} round {with_unit(radius(arc), 'm')} at "
            f"{1e3 * abs(arc.speed):.1f} mm/s"
        )

    @property
    def message(self) -> str:
        """The outcome in a paragraph."""
        text = super().message
        arc = self.arc
        if arc is None or self.status is not Status.OPTIMAL:
            return text
        found = "The fastest gait found drives "
        turn = (
            f"The fastest turn found goes {direction_text(arc.speed)} and to the "
            f"{side(arc.curvature)}, round a circle of radius {with_unit(radius(arc), 'm')}, "
        )
        return text.replace(found + direction_text(arc.speed) + " ", turn, 1) + self._opened()

    def _opened(self) -> str:
        bounds = self.optimum.problem.gait.offset
        return (
            " The problem fixes the offset, and a turn needs one: it was opened to all that the "
            f"limits allow, {number(bounds.low)} to {number(bounds.high)} rad."
            if self.opened
            else ""
        )


def circle_checks(circle: CircleCheck) -> list[Check]:
    """The circle's checks, and how a start from rest comes to it."""
    tail = f"(at most {LARGEST:.0e} allowed)."
    start = circle.transient
    ahead = "behind" if start.lost >= 0 else "ahead of"
    return [
        Check(
            max(circle.ends, circle.mean) <= LARGEST,
            f"{PERIODS} periods by CVODES: P is at most {circle.ends:.1e} of the radius from where "
            f"the circle has it, and the mean circle's radius differs by {circle.mean:.1e} {tail}",
        ),
        Check(
            circle.rest <= LARGEST,
            f"From rest, after {circle.periods} periods by CVODES: the radius differs by "
            f"{circle.rest:.1e} {tail} The deviation falls to 1/e in "
            f"{with_unit(start.constant, 's')}, and the robot stays "
            f"{with_unit(abs(start.lost), 'm')} {ahead} one that is steady from the start.",
        ),
    ]


def side(value: float) -> str:
    """Which way a positive or negative turn goes."""
    return "left" if value > 0 else "right"


def radius(arc: Arc) -> float:
    """m, positive."""
    return abs(1 / arc.curvature) if arc.curvature else math.inf
