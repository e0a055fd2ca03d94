"""The fastest turn, with its arc and the check of its circle; the turning chart of a robot."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from rr_opt.design.turn import MeanMotion, Target
from rr_opt.documents import document as doc
from rr_opt.files.record import plain
from rr_opt.formatting import direction_text, number, side_text, with_unit
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import ANY, Problem
from rr_opt.outcome import Status
from rr_opt.results.fastest import FastestGait
from rr_opt.results.gait import ignored_effects, speed_fact
from rr_opt.results.result import Check, Result, picked
from rr_opt.verify.replay import LARGEST, PERIODS, CircleCheck
from rr_opt.verify.turn_chart import RadiusClaim, SignClaim, Tightest, TurnMap


@dataclass(frozen=True, repr=False)
class FastestTurn(FastestGait):
    """The fastest gait that makes a turn: as FastestGait, and

    target   the request
    opened   whether the problem fixed the offset, and it was freed for the turn
    arc      heading, curvature, time and length of the turn; None where there is no gait
    circle   whether the robot stays on the circle, and converges to it from rest; None likewise
    """

    DRAW = "rr_opt.results.figures.fastest.draw_turn"
    CAPTIONS: ClassVar = {**FastestGait.CAPTIONS, **doc.captions("turn")}

    target: Target = field(default_factory=Target)
    opened: bool = False
    arc: MeanMotion | None = None
    circle: CircleCheck | None = None

    @property
    def radius(self) -> float | None:
        """Radius of the circle, m, positive, inf for a straight line; None if there is no gait."""
        if self.arc is None:
            return None
        return abs(1 / self.arc.curvature) if self.arc.curvature else math.inf

    @property
    def turn_prices(self) -> dict[str, float]:
        """Shadow prices of the requested turn, m/s of |speed| per SI unit."""
        best, turn = self.optimum.best, self.problem.turn
        if best is None or turn is None:
            return {}
        names = ("curvature", "yaw_rate", "heading")
        return {name: best.prices[name] for name in names if getattr(turn, name) != ANY}

    @property
    def checks(self) -> list[Check]:
        """The checks of any fastest gait, and of the circle."""
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
        """Further remarks on the gait, in sentences."""
        if not self.opened or self.arc is None:
            return super().remarks
        bounds = self.problem.gait.offset
        return [
            *super().remarks,
            "The problem fixes the offset, which a turn needs: it was freed within the limits, "
            f"{number(bounds.low)} to {number(bounds.high)} rad.",
        ]

    def _record(self) -> dict[str, Any]:
        """The content of result.json: that of any fastest gait, plus `turn`."""
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
        return doc.section("Turn", doc.facts(_facts(self, self.arc) if self.arc else ()))


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
    """The arc, or the full circle, and the gain from a slightly easier turn."""
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


_SPIN = 1e-4
"""A robot with a smaller radius, m, turns on the spot."""

_AGREED = 1e-3
"""Largest relative difference at which two searches agree."""


@dataclass(frozen=True, repr=False)
class TurnChart(Result):
    """The circles that a robot can drive.

    seen          the map drawn and written, as arrays
    tight         the tightest circle within the limits; None if no gait respects them
    sign, radius  the paper's claim on the offset, tested on a finer map
    """

    FILE = "turn-chart.json"
    OTHERS = ("turn-chart.csv",)
    DRAW = "rr_opt.results.figures.fastest.draw_chart"
    CAPTIONS = doc.captions("turn chart")

    name: str
    sha256: str
    problem: Problem
    seen: TurnMap
    tight: Tightest | None
    sign: SignClaim
    radius: RadiusClaim

    @property
    def status(self) -> Status:
        """INFEASIBLE if no gait respects every limit."""
        return Status.OPTIMAL if self.tight else Status.INFEASIBLE

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        if self.tight is None:
            return "None of the gaits tried both turns and respects every limit. Widen the bounds."
        radius, error = self.tight.radius, self.tight.error
        if radius < _SPIN:
            return (
                "The robot can turn on the spot: where its speed passes through 0 the circles "
                f"become arbitrarily tight, next to {sine_text(self.tight.gait)}."
            )
        text = (
            f"The tightest circle found within the limits has a radius of {with_unit(radius, 'm')}"
        )
        if error > _AGREED * radius:
            return f"{text}. Two searches differ by {error:.1e} m: there may be a tighter one."
        return f"{text}, and two searches agree on it to {max(error, 1e-9):.1e} m."

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the chart ignores, and whether it shows one side only."""
        one_sided = () if self.seen.two_sided else (
            "The robot's two sides differ. The chart shows only offsets of 0 and above.",
        )  # fmt: skip
        return (*ignored_effects(self.problem.robot), *one_sided)

    def _record(self) -> dict[str, Any]:
        sign, radius = self.sign, self.radius
        return {
            "status": "charted" if self.tight else self.status.value,
            "message": self.message,
            "problem": self.name,
            "tightest": self.tight,
            "sign_claim": {"holds": sign.holds, "holds_each_way": sign.holds_each_way}
            | plain(sign),
            "radius_claim": {"holds": radius.holds, **plain(radius)},
        }

    def _tables(self) -> dict[str, str]:
        """A row for each gait, SI; offsets of both signs, or of one if the two sides differ.

        Cells are empty if there is no steady cycle within the limits on the angle.
        """
        seen = self.seen
        alpha, T, phi0 = np.meshgrid(seen.amplitude, seen.period, seen.offset, indexing="ij")
        arrays = (alpha, T, phi0, seen.curvature, seen.speed, seen.heading, seen.peak_torque)
        parts = [*arrays, seen.keeps.astype(int)]
        # phi0 and -phi0 are mirror images: turning quantities change sign.
        left = slice(None, 0, -1) if seen.two_sided else slice(0, 0)
        mirror = [-part if i in (2, 3, 5) else part for i, part in enumerate(parts)]
        both = [
            np.concatenate([there[..., left], here], axis=-1).ravel() + 0
            for here, there in zip(parts, mirror, strict=True)
        ]
        return {"turn-chart.csv": doc.csv_columns(COLUMNS, both)}

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The tightest circle, and the paper's claim on the offset."""
        tight = self.tight
        facts: tuple[doc.Section, ...] = ()
        if tight:
            circle = f"{with_unit(tight.radius, 'm')} by {sine_text(tight.gait)}"
            texts = {
                "": (doc.Fact("tightest", circle), speed_fact(tight.speed)),
                "The sign of the offset sets the side": _sign_facts(self.sign),
                "A larger offset makes a smaller radius": _radius_facts(self.radius),
            }
            facts = tuple(doc.section(title, doc.facts(each)) for title, each in texts.items())
        failure = "No gait that turns respects every limit"
        return self._outcome("turn chart", self.message, failure, *facts, doc.gallery(figures))


def sine_text(gait: SineGait) -> str:
    """`amplitude 0.5 rad, period 1 s, offset 0.1 rad`."""
    return (
        f"amplitude {with_unit(gait.amplitude, 'rad')}, period {with_unit(gait.period, 's')}, "
        f"offset {with_unit(gait.offset, 'rad')}"
    )


COLUMNS = (
    "amplitude [rad]", "period [s]", "offset [rad]", "curvature [1/m]", "speed [m/s]",
    "heading_per_period [rad]", "peak_torque [N m]", "keeps_limits",
)  # fmt: skip


def _sign_facts(claim: SignClaim) -> Iterator[doc.Fact]:
    verdict = (
        f"holds for all {claim.gaits} gaits"
        if claim.holds
        else f"fails: {claim.rarer} of {claim.gaits} gaits turn to the other side"
    )
    forward = f"{claim.forward_left} left, {claim.forward_right} right at offsets above 0"
    yield doc.Fact("verdict", verdict)
    yield doc.Fact("forward", forward)
    yield doc.Fact("backward", f"{claim.backward_left} left, {claim.backward_right} right")
    if claim.exception:
        yield doc.Fact("first at", sine_text(claim.exception))


def _radius_facts(claim: RadiusClaim) -> Iterator[doc.Fact]:
    curves = f"{claim.curves} curves of one amplitude and period"
    if claim.first is None or claim.worst is None:
        yield doc.Fact("verdict", f"holds on all {curves}")
        return
    most = (
        "grows without bound to a straight line, where the turn changes sides"
        if math.isinf(claim.factor)
        else f"reaches {number(claim.factor)} times its least"
    )
    yield doc.Fact("verdict", f"fails on {claim.growing} of {curves}")
    yield doc.Fact("first at", sine_text(claim.first))
    yield doc.Fact("worst", f"the radius {most}, by {sine_text(claim.worst)}")
