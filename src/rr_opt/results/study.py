"""A study that was solved."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from rr_opt.array import Array
from rr_opt.design.study.plan import branches, plan
from rr_opt.design.study.row import Row
from rr_opt.documents.report import Progress, quiet
from rr_opt.files.study_file import Study
from rr_opt.formatting import direction_text, pace_text
from rr_opt.outcome import Status
from rr_opt.results.ignored import ignored_effects
from rr_opt.results.inputs import axis_words, setting_text, value_text
from rr_opt.results.result import Result

_SAME_SPEED = 1e-8
"""Cases whose speeds differ by less, relative, are equally fast."""


@dataclass(frozen=True, repr=False)
class SolvedStudy(Result):
    """A study with all its rows.

    rows  one for each case, in the order of `study.problems`; `row.optimum` is None where there is
          none, and `row.message` says why
    """

    REPORT = "rr_opt.report.study"

    study: Study
    rows: tuple[Row, ...]

    @property
    def name(self) -> str:
        """Of the study."""
        return self.study.name

    @property
    def sha256(self) -> str:
        """The fingerprint of its files."""
        return self.study.sha256

    @cached_property
    def branches(self) -> tuple[int | None, ...]:
        """The number of each case's branch of optima, or None."""
        adjacent = plan([axis.numbers for axis in self.study.axes], self.study.shape).adjacent
        return tuple(branches(self.rows, adjacent))

    def values(self, name: str) -> Array:
        """A number of every optimum by its name in `row.optimum`, nan where there is none."""
        return np.array(
            [np.nan if row.optimum is None else getattr(row.optimum, name) for row in self.rows],
            float,
        )

    @property
    def speed(self) -> Array:
        """|speed| of every case, m/s; nan where there is no optimum."""
        return np.abs(self.values("speed"))

    @property
    def fastest(self) -> int | None:
        """The number of the case with the fastest optimum; of equally fast ones the first."""
        speed = self.speed
        if np.isnan(speed).all():
            return None
        return int(np.flatnonzero(speed >= np.nanmax(speed) * (1 - _SAME_SPEED))[0])

    @property
    def counts(self) -> dict[Status, int]:
        """How many rows ended in each way."""
        counted = Counter(row.status for row in self.rows)
        return {status: counted[status] for status in Status}

    def front(self, cost: str) -> list[int]:
        """The cases that no other one beats in both: less cost and more speed; cheapest first.

        cost: name of the number in `row.optimum`
        """
        costs, speed = self.values(cost), self.speed
        best, kept = -np.inf, []
        for case in np.lexsort((-speed, costs)):
            if np.isfinite(costs[case]) and speed[case] > best:
                kept.append(int(case))
                best = speed[case]
        return kept

    def value_texts(self, case: int) -> list[str]:
        """The values of a case, one text for each axis."""
        inputs = self.study.inputs(case)
        texts = [
            [value_text(line.key, inputs[line.key.name]) for line in axis.lines]
            for axis in self.study.axes
        ]
        return [" and ".join(dict.fromkeys(several)) for several in texts]

    def inputs_text(self, case: int) -> str:
        """`rate limit 30 rpm, direction forward`."""
        words = map(axis_words, self.study.axes)
        return ", ".join(map(setting_text, words, self.value_texts(case)))

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        best = self.fastest
        if best is None:
            return f"None of the {len(self.rows)} cases has an optimum."
        speed = float(self.values("speed")[best])
        return (
            f"The fastest of {len(self.rows)} cases drives {direction_text(speed)} at "
            f"{pace_text(speed)} ({self.inputs_text(best)})."
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the study ignores, and how many cases have no optimum."""
        words = {
            Status.INFEASIBLE: "no gait that respects all limits",
            Status.NOT_CONVERGED: "no optimum that the solver could confirm",
        }
        counts = self.counts
        return ignored_effects(self.study.problems[0].robot) + tuple(
            f"{counts[status]} of {len(self.rows)} cases: {text}. Their rows give the reasons."
            for status, text in words.items()
            if counts[status]
        )

    @property
    def status(self) -> Status:
        """OPTIMAL if any case has an optimum; else INFEASIBLE if no case has a feasible gait."""
        counts = self.counts
        if counts[Status.OPTIMAL]:
            return Status.OPTIMAL
        return Status.NOT_CONVERGED if counts[Status.NOT_CONVERGED] else Status.INFEASIBLE

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        netcdf: bool = False,
    ) -> list[Path]:
        """Write study.csv, study.json and, if asked for, study.nc, with figures and page."""
        options = {"figures": figures, "progress": progress, "netcdf": netcdf}
        return self.report.save(self, path, **options)
