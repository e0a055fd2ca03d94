"""The turning chart of a robot: its circles, the tightest of them, and the paper's claim."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from rr_opt.files.record import plain
from rr_opt.formatting import number, with_unit
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.outcome import Status
from rr_opt.report.document import (
    Captions,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Section,
    csv_text,
    versions,
)
from rr_opt.report.gait import ignored_effects, speed_fact
from rr_opt.report.result import Result
from rr_opt.verify.turn_chart import RadiusClaim, SignClaim, Tightest, TurnMap
from rr_opt.version import __version__

_SPIN = 1e-4
"""A smaller radius, m, is that of a robot that turns on the spot."""
_AGREED = 1e-3
"""Two searches agree if they differ by no more, relative."""

COLUMNS = (
    "amplitude", "period", "offset", "curvature", "speed", "heading_per_period", "peak_torque",
    "keeps_limits",
)  # fmt: skip


@dataclass(frozen=True, repr=False)
class TurnChart(Result):
    """The circles that a robot can drive.

    seen          the map drawn and written, as arrays
    tight         the tightest circle within the limits; None if no gait respects them
    sign, radius  the paper's claim on the offset, tested on a finer map
    """

    RECORD = "turn-chart.json"
    OTHERS = ("turn-chart.csv",)
    CAPTIONS: ClassVar[Captions] = {
        "turn-chart": (
            "Radius over offset",
            "Radius over offset, a panel for each period and a line for each amplitude",
            "Solid lines turn to the left, dashed ones to the right; a line ends where a limit is "
            "exceeded.",
        )
    }

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
                f"become arbitrarily tight, next to {_sine(self.tight.gait)}."
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
            "The robot's two sides differ. The chart shows offsets of 0 and more only.",
        )  # fmt: skip
        return (*ignored_effects(self.problem.robot), *one_sided)

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of turn-chart.json."""
        sign = {"holds": self.sign.holds, "holds_each_way": self.sign.holds_each_way}
        record = {
            "status": "charted" if self.tight else self.status.value,
            "message": self.message,
            "problem": self.name,
            "tightest": self.tight,
            "sign_claim": sign | plain(self.sign),
            "radius_claim": {"holds": self.radius.holds, **plain(self.radius)},
            "version": __version__,
            "input_sha256": self.sha256,
        }
        return plain(record)

    def _tables(self) -> dict[str, str]:
        """A row for each gait, SI, offsets of both signs, or of one if the robot's two sides
        differ; empty where there is no steady cycle within the limits on the angle."""
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
        return {"turn-chart.csv": csv_text(COLUMNS, rows)}

    def document(self, figures: Sequence[Figure] = ()) -> Document:
        """The tightest circle, and the paper's claim on the offset."""
        tight = self.tight
        facts: tuple[Section, ...] = ()
        if tight:
            circle = f"{with_unit(tight.radius, 'm')} by {_sine(tight.gait)}"
            tightest = Facts((Fact("tightest", circle), speed_fact(tight.speed)))
            facts = (
                Section("", (tightest,)),
                Section("The sign of the offset sets the side", (_sign_facts(self.sign),)),
                Section("A larger offset makes a smaller radius", (_radius_facts(self.radius),)),
            )
        return Document(
            self.name,
            "turn chart",
            self.message if tight else "No gait that turns respects every limit",
            "" if tight else self.message,
            (*facts, Section("", (Gallery(tuple(figures)),), brief=False)),
            good=tight is not None,
            footer=versions(self.sha256),
        )

    def _drawn(self) -> dict[str, str]:
        from rr_opt.report.figures.turn_chart import draw

        return {"turn-chart": draw(self.seen, self.tight)}


def _sign_facts(claim: SignClaim) -> Facts:
    verdict = (
        f"holds for all {claim.gaits} gaits"
        if claim.holds
        else f"fails: {claim.rarer} of {claim.gaits} gaits turn to the other side"
    )
    forward = f"{claim.forward_left} left, {claim.forward_right} right at offsets above 0"
    facts = [
        Fact("verdict", verdict),
        Fact("forward", forward),
        Fact("backward", f"{claim.backward_left} left, {claim.backward_right} right"),
    ]
    if claim.exception:
        facts.append(Fact("first at", _sine(claim.exception)))
    return Facts(tuple(facts))


def _radius_facts(claim: RadiusClaim) -> Facts:
    curves = f"{claim.curves} curves of one amplitude and period"
    if claim.first is None or claim.worst is None:
        return Facts((Fact("verdict", f"holds on all {curves}"),))
    most = (
        "grows without bound to a straight line, where the turn changes sides"
        if math.isinf(claim.factor)
        else f"reaches {number(claim.factor)} times its least"
    )
    return Facts(
        (
            Fact("verdict", f"fails on {claim.growing} of {curves}"),
            Fact("first at", _sine(claim.first)),
            Fact("worst", f"the radius {most}, by {_sine(claim.worst)}"),
        )
    )


def _sine(gait: SineGait) -> str:
    """`amplitude 0.5 rad, period 1 s, offset 0.1 rad`."""
    return (
        f"amplitude {with_unit(gait.amplitude, 'rad')}, period {with_unit(gait.period, 's')}, "
        f"offset {with_unit(gait.offset, 'rad')}"
    )
