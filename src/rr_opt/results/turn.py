"""The fastest turn: a fastest gait with the arc it drives and the check of its circle."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

from rr_opt.design.turn import MeanMotion, Target
from rr_opt.documents import document as doc
from rr_opt.documents.texts import captions
from rr_opt.files.record import plain
from rr_opt.formatting import direction_text, number, side_text, with_unit
from rr_opt.model.problem import ANY
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Check, picked
from rr_opt.verify.replay import LARGEST, PERIODS, CircleCheck


@dataclass(frozen=True, repr=False)
class FastestTurn(FastestGait):
    """The fastest gait that makes a turn: as FastestGait, and

    target   what was asked
    opened   whether the problem fixed the offset, which a turn needs, and it was freed
    arc      heading, curvature, time and length of the turn; None where there is no gait
    circle   whether the robot stays on the circle, and comes to it from rest; None likewise
    """

    DRAW = "rr_opt.results.figures.turn.draw_turn"
    CAPTIONS: ClassVar = {**FastestGait.CAPTIONS, **captions("turn")}

    target: Target = field(default_factory=Target)
    opened: bool = False
    arc: MeanMotion | None = None
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
            f"{self._found('turn')} goes {direction_text(arc.speed)} and to the "
            f"{side_text(arc.curvature)} round {with_unit(self.radius, 'm')} at "
            f"{1e3 * abs(arc.speed):.1f} mm/s"
        )

    @property
    def _subject(self) -> str:
        arc = self.arc
        if arc is None or self.radius is None:
            return super()._subject
        return (
            f"{self._found('turn')} goes {direction_text(arc.speed)} and to the "
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

    def _record(self) -> dict[str, Any]:
        """The content of result.json: that of any fastest gait, and `turn`."""
        record, target, circle = super()._record(), self.target, self.circle
        own = {
            "asked": {
                **picked(target, "heading radius within length"),
                "cycles": "whole" if target.whole else "any",
            },
            "offset_opened": self.opened,
            "arc": self.arc and {**plain(self.arc), "radius": self.radius},
            "prices": self.turn_prices,
            "circle_check": circle
            and {
                **picked(circle, "ends mean rest"),
                "rest_periods": circle.periods,
                "time_constant": circle.transient.constant,
                "distance_lost": circle.transient.lost,
                "delay": circle.transient.delay,
            },
        }
        return record | {"turn": plain(own), "units": {**record["units"], **UNITS}}

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The report of a fastest gait, with its arc."""
        return replace(super().document(figures), kind="fastest turn")

    def _lead(self) -> doc.Section:
        facts = tuple(_facts(self, self.arc)) if self.arc else ()
        return doc.Section("Turn", (doc.Facts(facts),))


def _circle_checks(circle: CircleCheck) -> list[Check]:
    """Whether P stays on the circle, and whether a start from rest converges to it."""
    tail = f"(tolerance {LARGEST:.0e})."
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
            f"From rest by CVODES, after {circle.periods} periods: the radius differs by "
            f"{circle.rest:.1e} {tail} The deviation falls to 1/e in "
            f"{with_unit(start.constant, 's')}, and the robot stays "
            f"{with_unit(abs(start.lost), 'm')} {ahead} one that is steady from the start.",
        ),
    ]


UNITS = {
    "heading": "rad, positive to the left",
    "curvature": "1/m, heading per metre of the mean circle",
    "yaw_rate": "rad/s",
    "length": "m, along the mean circle",
    "time": "s",
    "price of curvature, yaw_rate, heading": "m/s of |speed| per SI unit by which it is raised; "
    "with the objective cost_of_transport how much that falls",
}


def _facts(turn: FastestTurn, arc: MeanMotion) -> Iterator[doc.Fact]:
    """The arc, or the full circle, and what a slightly easier turn would gain."""
    name = "circle" if turn.target.heading is None else "arc"
    degrees = abs(math.degrees(arc.heading))
    yield doc.Fact(name, f"{number(degrees)} deg to the {side_text(arc.heading)}")
    yield doc.Fact("radius", with_unit(turn.radius or math.inf, "m"))
    periods = f"{number(arc.periods, 6)} periods, steady motion"
    yield doc.Fact("time", with_unit(arc.time, "s"), periods)
    yield doc.Fact("length", f"{with_unit(arc.length, 'm')} along the mean circle")
    yield doc.Fact("yaw rate", f"{number(math.degrees(arc.yaw_rate))} deg/s")
    asked = {
        "curvature": (arc.curvature, "a 1 % larger radius"),
        "yaw_rate": (arc.yaw_rate, "a 1 % lower yaw rate"),
        "heading": (arc.heading / arc.periods, "1 % less heading per period"),
    }
    for name, price in turn.turn_prices.items():
        value, words = asked[name]
        gain = -0.01 * value * price
        if abs(gain) > 1e-9:
            per = f"{-gain:+.3g}" if turn.cost else f"{1e3 * gain:+.3g} mm/s"
            yield doc.Fact("price", f"{per} for {words}")
