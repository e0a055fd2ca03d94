"""The folder of a calibration: calibration.json, the tables, the figures and the page."""

from __future__ import annotations

from pathlib import Path

from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.calibration.page import page
from rr_opt.report.calibration.record import record
from rr_opt.report.calibration.tables import tables

RECORD, PAGE = "calibration.json", "report.html"


def write_calibration(found: Calibration, folder: Path) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    texts, drawn = tables(found), draw(found)
    remove(folder, (RECORD, PAGE, *texts, *(f"{name}.svg" for name in drawn)))
    written = [write_json(folder / RECORD, record(found))]
    written += [write_text(folder / name, text) for name, text in texts.items()]
    written += [write_text(folder / f"{name}.svg", text) for name, text in drawn.items()]
    return [write_text(folder / PAGE, page(found, drawn)), *written]


def draw(found: Calibration) -> dict[str, str]:
    """The figures as SVG texts by name."""
    from rr_opt.report.figures.calibration.coverage import coverage  # noqa: PLC0415
    from rr_opt.report.figures.calibration.predictions import predictions  # noqa: PLC0415
    from rr_opt.report.figures.calibration.unknowns import unknowns  # noqa: PLC0415
    from rr_opt.report.figures.style import figure, styled, svg  # noqa: PLC0415

    with styled():
        held = figure(6.6, 3.8)
        coverage(held.subplots(), found.coverage)
        return {
            "unknowns": svg(unknowns(found)),
            "predictions": svg(predictions(found)),
            "coverage": svg(held),
        }
