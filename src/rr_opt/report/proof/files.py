"""The files of a blind trial: the record, the table, the figure, the page and the summary."""

from __future__ import annotations

from pathlib import Path

from rr_opt.proof.opened import Opened
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.proof.record import record
from rr_opt.report.proof.summary import summary
from rr_opt.report.proof.table import csv_text

RECORD, TABLE, SUMMARY, PAGE, FIGURE = (
    "proof.json", "cases.csv", "README.md", "report.html", "confusion.svg",
)  # fmt: skip


def write_proof(opened: Opened, folder: Path) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    remove(folder, (RECORD, TABLE, SUMMARY, PAGE, FIGURE))
    from rr_opt.report.figures.proof.confusion import draw  # noqa: PLC0415
    from rr_opt.report.proof.page import page  # noqa: PLC0415

    drawn = draw(opened)
    text = summary(opened).replace(
        "\n\n", f"\n\n![What was said of what was hidden]({FIGURE})\n\n", 1
    )
    return [
        write_text(folder / PAGE, page(opened, drawn)),
        write_text(folder / SUMMARY, text),
        write_json(folder / RECORD, record(opened)),
        write_text(folder / TABLE, csv_text(opened)),
        write_text(folder / FIGURE, drawn),
    ]
