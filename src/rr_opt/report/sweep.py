"""The report of a sweep: its best gait, and a row for each gait as CSV."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rr_opt.documents import document as doc
from rr_opt.documents.report import Report
from rr_opt.documents.texts import captions
from rr_opt.formatting import number, with_unit
from rr_opt.report.gait import gait_facts, speed_fact
from rr_opt.results.sweep import Sweep
from rr_opt.verify.evaluate import LIMITS, Found
from rr_opt.verify.grid import DECISIONS


def record(result: Sweep) -> dict[str, Any]:
    """The content of sweep.json. status: `swept`, as a sweep proves no optimum."""
    found = result.found
    return {
        "status": "swept" if result.best else result.status.value,
        "message": result.message,
        "problem": result.name,
        "points": found.points,
        "feasible": found.found.feasible.sum(),
        "failed": found.found.failed,
        "best": _found(result.best),
        "best_of_grid": _found(found.best),
    }


def _found(one: Found | None) -> dict[str, Any] | None:
    return one and {
        "gait": one.gait,
        "inertia_ratio": one.ratio,
        "speed": one.speed,
        "peak_torque": one.peak_torque,
    }


def tables(result: Sweep) -> dict[str, str]:
    """A row for each gait of the grid, SI; 1 in the column of a limit that it respects.

    An empty ratio is the robot as it is; an empty speed, a gait at or past the limits on the angle.
    """
    found = result.found.found
    names = (*DECISIONS, "speed", "peak_torque", *(f"keeps_{name}" for name in LIMITS))
    kept = [found.keeps[name].astype(int) for name in LIMITS]
    columns = [*found.decisions, found.speed, found.peak_torque, *kept]
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return {"sweep.csv": doc.csv_text(names, rows)}


def document(result: Sweep, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """The best gait and the grid."""
    best, grid = result.best, result.found.found
    facts: list[doc.Fact] = []
    if best:
        ratio = "the robot as it is" if best.ratio is None else number(best.ratio)
        facts = [
            *gait_facts(best.gait),
            doc.Fact("J20/J10", ratio),
            speed_fact(best.speed),
            doc.Fact("torque", f"{with_unit(best.peak_torque, 'N m')} at most"),
        ]
    kept = f"{len(grid.speed)} gaits, of which {int(grid.feasible.sum())} respect all limits"
    return doc.Document(
        result.name,
        "sweep",
        result.message if best else "No gait respects every limit",
        "" if best else result.message,
        (doc.Section("", (doc.Facts((*facts, doc.Fact("grid", kept))),)), doc.gallery(figures)),
        good=best is not None,
        footer=doc.versions(result.sha256),
    )


REPORT = Report(
    record,
    document,
    "sweep.json",
    tables=tables,
    others=("sweep.csv",),
    figures="rr_opt.report.figures.sweep",
    captions=captions("sweep"),
)
