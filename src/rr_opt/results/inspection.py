"""Recordings as they were found: what was read of each, and everything that looks wrong."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rr_opt.documents.report import Progress, quiet
from rr_opt.recordings.inspection import Inspection
from rr_opt.results.result import Result


@dataclass(frozen=True, repr=False)
class InspectedRecordings(Result):
    """Recordings as they were found.

    recordings  one each, with `recording` (values, sigma and flags by channel), `doubts`, the
                markers' fit and the clock against the command
    """

    REPORT = "rr_opt.report.inspection"

    name: str
    sha256: str
    recordings: tuple[Inspection, ...]

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        netcdf: str | Path | None = None,
    ) -> list[Path]:
        """Write inspection.json and the page; netcdf: a file for the one recording."""
        options = {"figures": figures, "progress": progress, "netcdf": netcdf}
        return self.report.save(self, path, **options)
