"""The figure of a plain sweep, as SVG text."""

from __future__ import annotations

from rr_opt.report.figures.style import figure, styled, svg
from rr_opt.report.figures.sweep import sweep
from rr_opt.verify.evaluate import Evaluated, Found

_MANY = 2000


def draw(found: Evaluated, best: Found | None) -> str:
    """Draw the sweep. Many dots become one picture inside the SVG, to keep it small."""
    with styled():
        drawn = figure(6.8, 4.8)
        drawn.set_dpi(160)
        ax = sweep(drawn.add_subplot(), found, best)
        for part in (*ax.collections, *ax.lines[:1]):
            part.set_rasterized(len(found.speed) > _MANY)
        return svg(drawn)
