"""The turning chart of a robot: its circles, the tightest of them, and the paper's claim."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.texts import captions
from rr_opt.files.record import plain
from rr_opt.formatting import number, with_unit
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.outcome import Status
from rr_opt.results.gait import ignored_effects, speed_fact
from rr_opt.results.result import Result
from rr_opt.verify.turn_chart import RadiusClaim, SignClaim, Tightest, TurnMap

_SPIN = 1e-4
"""A smaller radius, m, is that of a robot that turns on the spot."""


_AGREED = 1e-3
"""Two searches agree if they differ by no more, relative."""


@dataclass(frozen=True, repr=False)
class TurnChart(Result):
    """The circles that a robot can drive.

    seen          the map drawn and written, as arrays
    tight         the tightest circle within the limits; None if no gait respects them
    sign, radius  the paper's claim on the offset, tested on a finer map
    """

    FILE = "turn-chart.json"
    OTHERS = ("turn-chart.csv",)
    DRAW = "rr_opt.results.figures.turn.draw_chart"
    CAPTIONS = captions("turn chart")

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
            return "None of the gaits tried turns and respects every limit. Widen the bounds."
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

        Cells are empty where there is no steady cycle within the limits on the angle.
        """
        seen = self.seen
        alpha, T, phi0 = np.meshgrid(seen.amplitude, seen.period, seen.offset, indexing="ij")
        arrays = (alpha, T, phi0, seen.curvature, seen.speed, seen.heading, seen.peak_torque)
        parts = [*arrays, seen.keeps.astype(int)]
        # phi0 and -phi0 are mirror images: what turns has the other sign there.
        left = slice(None, 0, -1) if seen.two_sided else slice(0, 0)
        mirror = [-part if i in (2, 3, 5) else part for i, part in enumerate(parts)]
        both = [
            np.concatenate([there[..., left], here], axis=-1).ravel() + 0
            for here, there in zip(parts, mirror, strict=True)
        ]
        rows = zip(*(part.tolist() for part in both), strict=True)
        return {"turn-chart.csv": doc.csv_text(COLUMNS, rows)}

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The tightest circle, and the paper's claim on the offset."""
        tight = self.tight
        facts: tuple[doc.Section, ...] = ()
        if tight:
            circle = f"{with_unit(tight.radius, 'm')} by {sine_text(tight.gait)}"
            tightest = doc.Facts((doc.Fact("tightest", circle), speed_fact(tight.speed)))
            facts = (
                doc.Section("", (tightest,)),
                doc.Section("The sign of the offset sets the side", (_sign_facts(self.sign),)),
                doc.Section(
                    "A larger offset makes a smaller radius", (_radius_facts(self.radius),)
                ),
            )
        return doc.Document(
            self.name,
            "turn chart",
            self.message if tight else "No gait that turns respects every limit",
            "" if tight else self.message,
            (*facts, doc.gallery(figures)),
            good=tight is not None,
            footer=doc.versions(self.sha256),
        )


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


def _sign_facts(claim: SignClaim) -> doc.Facts:
    verdict = (
        f"holds for all {claim.gaits} gaits"
        if claim.holds
        else f"fails: {claim.rarer} of {claim.gaits} gaits turn to the other side"
    )
    forward = f"{claim.forward_left} left, {claim.forward_right} right at offsets above 0"
    facts = [
        doc.Fact("verdict", verdict),
        doc.Fact("forward", forward),
        doc.Fact("backward", f"{claim.backward_left} left, {claim.backward_right} right"),
    ]
    if claim.exception:
        facts.append(doc.Fact("first at", sine_text(claim.exception)))
    return doc.Facts(tuple(facts))


def _radius_facts(claim: RadiusClaim) -> doc.Facts:
    curves = f"{claim.curves} curves of one amplitude and period"
    if claim.first is None or claim.worst is None:
        return doc.Facts((doc.Fact("verdict", f"holds on all {curves}"),))
    most = (
        "grows without bound to a straight line, where the turn changes sides"
        if math.isinf(claim.factor)
        else f"reaches {number(claim.factor)} times its least"
    )
    return doc.Facts(
        (
            doc.Fact("verdict", f"fails on {claim.growing} of {curves}"),
            doc.Fact("first at", sine_text(claim.first)),
            doc.Fact("worst", f"the radius {most}, by {sine_text(claim.worst)}"),
        )
    )
