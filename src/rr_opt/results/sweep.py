"""A plain sweep: a grid of gaits, the best of them, and a row for each as CSV."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from rr_opt.documents import document as doc
from rr_opt.formatting import direction_text, number, pace_text, with_unit
from rr_opt.model.problem import Problem
from rr_opt.outcome import Status
from rr_opt.results.gait import gait_facts, ignored_effects, speed_fact
from rr_opt.results.result import Result, picked
from rr_opt.verify.evaluate import LIMITS, Found
from rr_opt.verify.sweep import SweepResult

_COLUMNS = (
    "amplitude [rad]", "period [s]", "offset [rad]", "ratio", "speed [m/s]", "peak_torque [N m]",
)  # fmt: skip


@dataclass(frozen=True, repr=False)
class Sweep(Result):
    """Gaits over the whole bounds: `found` has all of them as arrays, `best` is the best by the
    problem's objective."""

    FILE = "sweep.json"
    OTHERS = ("sweep.csv",)
    DRAW = "rr_opt.results.figures.fastest.draw_sweep"
    CAPTIONS = doc.captions("sweep")

    name: str
    sha256: str
    problem: Problem
    found: SweepResult

    @property
    def best(self) -> Found | None:
        """The best gait that respects every limit, on the grid or close to its best points."""
        both = [one for one in (self.found.refined, self.found.best) if one is not None]
        return max(both, key=lambda one: one.merit, default=None)

    @property
    def status(self) -> Status:
        """INFEASIBLE if no gait of the sweep respects every limit."""
        return Status.OPTIMAL if self.best else Status.INFEASIBLE

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        if self.best is None:
            return f"None of the {self.found.points} gaits tried respects every limit."
        which = "fastest"
        if self.problem.objective != "speed":
            which = f"one with the lowest cost of transport, {number(1 / self.best.merit)},"
        tried = f"The {which} of {self.found.points} gaits"
        return f"{tried} drives {direction_text(self.best.speed)} at {pace_text(self.best.speed)}."

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the sweep ignores."""
        return ignored_effects(self.problem.robot)

    def _record(self) -> dict[str, Any]:
        """The content of sweep.json. status: `swept`, as a sweep proves no optimum."""
        found = self.found
        return {
            "status": "swept" if self.best else self.status.value,
            "message": self.message,
            "problem": self.name,
            "points": found.points,
            "feasible": found.found.feasible.sum(),
            "failed": found.found.failed,
            "best": _found(self.best),
            "best_of_grid": _found(found.best),
        }

    def _tables(self) -> dict[str, str]:
        """A row for each gait of the grid, SI; 1 in the column of a limit that it respects.

        An empty ratio is the robot as it is; an empty speed means that the gait is at or beyond the
        limits on the angle.
        """
        found = self.found.found
        names = (*_COLUMNS, *(f"keeps_{name}" for name in LIMITS))
        kept = [found.keeps[name].astype(int) for name in LIMITS]
        columns = [*found.decisions, found.speed, found.peak_torque, *kept]
        return {"sweep.csv": doc.csv_columns(names, columns)}

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The best gait and the grid."""
        best, grid = self.best, self.found.found
        kept = f"{len(grid.speed)} gaits, of which {int(grid.feasible.sum())} respect all limits"
        facts = [*_facts(best), doc.Fact("grid", kept)] if best else [doc.Fact("grid", kept)]
        sections = doc.section("", doc.facts(facts)), doc.gallery(figures)
        return self._outcome("sweep", self.message, "No gait respects every limit", *sections)


def _facts(best: Found) -> Iterator[doc.Fact]:
    ratio = "the robot as it is" if best.ratio is None else number(best.ratio)
    yield from gait_facts(best.gait)
    yield doc.Fact("J20/J10", ratio)
    yield speed_fact(best.speed)
    yield doc.Fact("torque", f"{with_unit(best.peak_torque, 'N m')} at most")


def _found(one: Found | None) -> dict[str, Any] | None:
    return one and {"inertia_ratio": one.ratio, **picked(one, "gait speed peak_torque")}
