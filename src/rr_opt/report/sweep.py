"""A plain sweep: every gait tried, and the best of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from rr_opt.files.record import plain
from rr_opt.formatting import direction_text, number, pace_text, with_unit
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
from rr_opt.report.gait import gait_facts, ignored_effects, speed_fact
from rr_opt.report.result import Result
from rr_opt.verify.evaluate import LIMITS, Found
from rr_opt.verify.grid import DECISIONS
from rr_opt.verify.sweep import SweepResult
from rr_opt.version import __version__


@dataclass(frozen=True, repr=False)
class Sweep(Result):
    """Gaits all over the bounds: `found` has all of them as arrays, `best` the fastest."""

    RECORD = "sweep.json"
    OTHERS = ("sweep.csv",)
    CAPTIONS: ClassVar[Captions] = {
        "sweep": (
            "Speed over the bounds",
            "Every gait of the sweep by period and amplitude, coloured by its speed",
            "A dot for each gait that respects every limit, the fastest on top; a cross for any "
            "other. The star is the best.",
        )
    }

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

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of sweep.json. status: `swept`, as a sweep proves no optimum."""
        record = {
            "status": "swept" if self.best else self.status.value,
            "message": self.message,
            "problem": self.name,
            "points": self.found.points,
            "feasible": self.found.found.feasible.sum(),
            "failed": self.found.found.failed,
            "best": _record(self.best),
            "best_of_grid": _record(self.found.best),
            "version": __version__,
            "input_sha256": self.sha256,
        }
        return plain(record)

    def _tables(self) -> dict[str, str]:
        """A row for each gait of the grid, SI; 1 in the column of a limit that it respects. An
        empty ratio is the robot as it is; an empty speed, a gait at or past the limits on the
        angle."""
        found = self.found.found
        names = (*DECISIONS, "speed", "peak_torque", *(f"keeps_{name}" for name in LIMITS))
        kept = [found.keeps[name].astype(int) for name in LIMITS]
        columns = [*found.decisions, found.speed, found.peak_torque, *kept]
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return {"sweep.csv": csv_text(names, rows)}

    def document(self, figures: Sequence[Figure] = ()) -> Document:
        """The best gait and the grid."""
        best, grid = self.best, self.found.found
        facts: list[Fact] = []
        if best:
            ratio = "the robot as it is" if best.ratio is None else number(best.ratio)
            facts = [
                *gait_facts(best.gait),
                Fact("J20/J10", ratio),
                speed_fact(best.speed),
                Fact("torque", f"{with_unit(best.peak_torque, 'N m')} at most"),
            ]
        kept = f"{len(grid.speed)} gaits, of which {int(grid.feasible.sum())} respect all limits"
        return Document(
            self.name,
            "sweep",
            self.message if best else "No gait respects every limit",
            "" if best else self.message,
            (
                Section("", (Facts((*facts, Fact("grid", kept))),)),
                Section("", (Gallery(tuple(figures)),), brief=False),
            ),
            good=best is not None,
            footer=versions(self.sha256),
        )

    def _drawn(self) -> dict[str, str]:
        from rr_opt.report.figures.speed_map import draw

        return {"sweep": draw(self.found.found, self.best)}


def _record(one: Found | None) -> dict[str, Any] | None:
    return one and {
        "gait": one.gait,
        "inertia_ratio": one.ratio,
        "speed": one.speed,
        "peak_torque": one.peak_torque,
    }
