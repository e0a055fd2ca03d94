"""The folder of the reproduction: page, audit, record, figures and their numbers."""

from __future__ import annotations

from pathlib import Path

from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.paper.cells import csv_text, markdown
from rr_opt.report.paper.curves import curves
from rr_opt.report.paper.result import Reproduced, record

FIGURES = ("figure3", "figure4", "figure5", "figure6", "signs", "readings", "period")
PAGE, AUDIT, RECORD = "report.html", "audit.md", "reproduce.json"


def write_reproduction(result: Reproduced, folder: Path, *, figures: bool) -> list[Path]:
    """Write everything; returns the files. What an earlier run left is removed before.

    A section's table goes to a CSV of its name; that of the columns holds Tables 2 and 3.
    """
    lines = curves(result.found)
    tables = {
        f"{'tables' if one.key == 'columns' else f'audit-{one.key}'}.csv": csv_text(
            one.head, one.rows
        )
        for one in result.sections
    }
    remove(folder, (PAGE, AUDIT, RECORD, *lines, *tables, *(f"{name}.svg" for name in FIGURES)))
    written = [
        write_text(folder / AUDIT, markdown(result.sections, result.lead)),
        write_json(folder / RECORD, record(result)),
        *(write_text(folder / name, text) for name, text in {**tables, **lines}.items()),
    ]
    if not figures:
        return written
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.paper.figures import draw  # noqa: PLC0415
    from rr_opt.report.paper.page import page  # noqa: PLC0415

    drawn = draw(result.found)
    written += [write_text(folder / f"{name}.svg", drawn[name]) for name in FIGURES]
    return [write_text(folder / PAGE, page(result, drawn)), *written]
