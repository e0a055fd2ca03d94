"""A plain sweep: every gait tried, and the best of them."""

from __future__ import annotations

from dataclasses import dataclass

from rr_opt.formatting import direction_text, pace_text
from rr_opt.model.problem import Problem
from rr_opt.outcome import Status
from rr_opt.results.ignored import ignored_effects
from rr_opt.results.result import Result
from rr_opt.verify.evaluate import Found
from rr_opt.verify.sweep import SweepResult


@dataclass(frozen=True, repr=False)
class Sweep(Result):
    """Gaits all over the bounds: `found` has all of them as arrays, `best` the fastest."""

    REPORT = "rr_opt.report.sweep"

    name: str
    sha256: str
    problem: Problem
    found: SweepResult

    @property
    def best(self) -> Found | None:
        """The fastest gait that respects every limit, on the grid or close to its best points."""
        both = [one for one in (self.found.refined, self.found.best) if one is not None]
        return max(both, key=lambda one: abs(one.speed), default=None)

    @property
    def status(self) -> Status:
        """INFEASIBLE if no gait of the sweep respects every limit."""
        return Status.OPTIMAL if self.best else Status.INFEASIBLE

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        if self.best is None:
            return f"None of the {self.found.points} gaits tried respects every limit."
        return (
            f"The fastest of {self.found.points} gaits drives {direction_text(self.best.speed)} "
            f"at {pace_text(self.best.speed)}."
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the sweep ignores."""
        return ignored_effects(self.problem.robot)
