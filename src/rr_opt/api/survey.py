"""All gaits of a problem, without a solver: the sweep, and the chart of its circles."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rr_opt.answers.sweep import SweepAnswer
from rr_opt.answers.turn_chart import TurnChartAnswer
from rr_opt.api.identity import identity
from rr_opt.api.load import PathLike, problem_of
from rr_opt.api.result import Plots, Progress, Result, quiet
from rr_opt.model.problem import Problem
from rr_opt.motion.dynamics import require_friction
from rr_opt.verify import sweep as verify
from rr_opt.verify.grid import free_decisions
from rr_opt.verify.turn_chart import radius_claim, sign_claim, tightest, turn_map


class Sweep(Result, SweepAnswer):
    """Gaits all over the bounds: `found` has all of them as arrays, `best` the fastest."""

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of sweep.json."""
        from rr_opt.report.sweep import record

        return record(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The best gait and the grid as text."""
        from rr_opt.report.sweep import summary

        return summary(self, list(files))

    def plot(self) -> Plots:
        """Speed over the bounds."""
        from rr_opt.report.figures.speed_map import draw

        return Plots({"sweep": draw(self.found.found, self.best)})

    def _write(self, folder: Path, figures: bool, progress: Progress) -> list[Path]:
        from rr_opt.report.sweep import write_sweep

        progress("files")
        return write_sweep(self, folder)


def sweep(
    problem: Problem | PathLike, points: int = 10_000, *, progress: Progress = quiet
) -> Sweep:
    """About so many gaits all over the bounds, each evaluated; the best is refined.

    Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    counts = max(2, math.ceil(points ** (1 / max(len(free_decisions(problem)), 1))))
    tried = verify.sweep(problem, counts, lambda done, of: progress(f"gait {done} of {of}"))
    return Sweep(*identity(problem), problem, tried)


_DRAWN = (6, 4, 121)
"""Amplitudes, periods and offsets of the chart."""
_TESTED = (24, 10, 101)
"""The same of the map on which the paper's claim is tested."""


class TurnChart(Result, TurnChartAnswer):
    """The circles of a robot: `seen` has them as arrays, `tight` is the tightest."""

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of turn-chart.json."""
        from rr_opt.report.turn_chart import chart_record

        return chart_record(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The tightest circle and the paper's claim as text."""
        from rr_opt.report.turn_chart import chart_summary

        return chart_summary(self, list(files))

    def plot(self) -> Plots:
        """Radius over offset."""
        from rr_opt.report.figures.turn_chart import draw

        return Plots({"turn-chart": draw(self.seen, self.tight)})

    def _write(self, folder: Path, figures: bool, progress: Progress) -> list[Path]:
        from rr_opt.report.turn_chart import write_chart

        progress("files")
        return write_chart(self, folder)


def turn_chart(problem: Problem | PathLike, *, progress: Progress = quiet) -> TurnChart:
    """Radius over offset, amplitude and period, and the tightest circle within the limits.

    The inertia ratio is that of the robot as it is. Raises InputError for a robot without friction.
    """
    problem = problem_of(problem)
    require_friction(problem.robot)
    progress("chart")
    seen = turn_map(problem, _DRAWN)
    progress("the paper's claim")
    fine = turn_map(problem, _TESTED)
    progress("tightest circle")
    tight = tightest(problem)
    claims = sign_claim(fine), radius_claim(fine)
    return TurnChart(*identity(problem), problem, seen, tight, *claims)
