"""The folder of a plain sweep: every gait tried, the best of them, and the figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rr_opt.answers.quantities import number, with_unit
from rr_opt.answers.sweep import SweepAnswer
from rr_opt.files.gait_record import gait_record
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.document import Document, Fact, Facts, Section, csv_text
from rr_opt.report.gait import gait_facts, speed_fact
from rr_opt.report.text import terminal
from rr_opt.verify.evaluate import LIMITS, Evaluated, Found
from rr_opt.verify.grid import DECISIONS
from rr_opt.version import __version__

_NAMES = ("sweep.json", "sweep.csv", "sweep.svg")


def record(swept: SweepAnswer) -> dict[str, Any]:
    """The content of sweep.json, SI. status: `swept`, as a sweep proves no optimum."""
    found, best = swept.found, swept.best
    return {
        "status": "swept" if best else swept.status.value,
        "message": swept.message,
        "problem": swept.name,
        "points": found.points,
        "feasible": int(found.found.feasible.sum()),
        "failed": found.found.failed,
        "best": _found_record(best),
        "best_of_grid": _found_record(found.best),
        "version": __version__,
        "input_sha256": swept.sha256,
    }


def _found_record(one: Found | None) -> dict[str, Any] | None:
    if one is None:
        return None
    return {
        "gait": gait_record(one.gait),
        "inertia_ratio": one.ratio,
        "speed": one.speed,
        "peak_torque": one.peak_torque,
    }


def summary(swept: SweepAnswer, files: list[Path]) -> str:
    """The sweep as text for a terminal."""
    best, grid = swept.best, swept.found.found
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
    section = Section("", (Facts((*facts, Fact("grid", kept))),))
    title = swept.message if best else "infeasible"
    return terminal(Document(swept.name, "sweep", title, "", (section,)), files)


def write_sweep(swept: SweepAnswer, folder: Path) -> list[Path]:
    """Write everything; what an earlier sweep left is removed before."""
    from rr_opt.report.figures.speed_map import draw

    remove(folder, _NAMES)
    return [
        write_json(folder / "sweep.json", record(swept)),
        write_text(folder / "sweep.csv", _csv(swept.found.found)),
        write_text(folder / "sweep.svg", draw(swept.found.found, swept.best)),
    ]


def _csv(found: Evaluated) -> str:
    """A row a gait of the grid, SI; 1 in a limit's column where it is kept. An empty ratio is the
    robot as it is; an empty speed, a gait at or past the limits on the angle."""
    names = (*DECISIONS, "speed", "peak_torque", *(f"keeps_{name}" for name in LIMITS))
    kept = [found.keeps[name].astype(int) for name in LIMITS]
    columns = [*found.decisions, found.speed, found.peak_torque, *kept]
    return csv_text(names, zip(*(column.tolist() for column in columns), strict=True))
