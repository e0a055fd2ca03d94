"""The turning chart of a robot: its circles, the tightest of them, and the paper's claim."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.formatting import with_unit
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Problem
from rr_opt.outcome import Status
from rr_opt.results.ignored import ignored_effects
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

    REPORT = "rr_opt.report.turn_chart"

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


def sine_text(gait: SineGait) -> str:
    """`amplitude 0.5 rad, period 1 s, offset 0.1 rad`."""
    return (
        f"amplitude {with_unit(gait.amplitude, 'rad')}, period {with_unit(gait.period, 's')}, "
        f"offset {with_unit(gait.offset, 'rad')}"
    )
