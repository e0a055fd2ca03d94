"""The folder of a comparison of shapes: a result for each, the table, the figure and the page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rr_opt.report.archive import remove, strict_json, write_json, write_text
from rr_opt.report.result import result
from rr_opt.report.shapes.compared import Compared, file_of, gain_of, label, record, speed_of, table

RECORD, TABLE, FIGURE, PAGE = "shapes.json", "shapes.csv", "shapes.svg", "report.html"


def write_shapes(
    compared: Compared, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    names = [file_of(answer) for answer in compared.answers]
    remove(folder, (RECORD, TABLE, FIGURE, PAGE, *names))
    written = [
        write_json(folder / RECORD, record(compared)),
        write_text(folder / TABLE, table(compared)),
    ]
    for answer, name in zip(compared.answers, names, strict=True):
        written.append(write_text(folder / name, strict_json(result(answer))))
    if not figures:
        return written
    progress("figures")
    drawn = draw(compared)
    if drawn:
        written.insert(0, write_text(folder / FIGURE, drawn))
    from rr_opt.report.shapes.page import page  # noqa: PLC0415

    return [write_text(folder / PAGE, page(compared, drawn)), *written]


def draw(compared: Compared) -> str:
    """The figure as SVG text; empty if no family has an optimum."""
    from rr_opt.report.figures.shapes import Line, shapes  # noqa: PLC0415
    from rr_opt.report.figures.style import figure, styled, svg  # noqa: PLC0415

    lines = [
        Line(label(one), one.optimum.best.gait, speed_of(one), gain_of(compared, one) or 0.0)
        for one in compared.solved
        if one.optimum.best
    ]
    if not lines:
        return ""
    with styled():
        drawn = figure(8.6, 4.2)
        axes = drawn.subplot_mosaic([["angle", "speed"], ["rate", "speed"]], width_ratios=[1.1, 1])
        in_order = [axes[name] for name in ("angle", "rate", "speed")]
        shapes(in_order, lines, compared.answers[0].optimum.problem.limits.rate)
        return svg(drawn)
