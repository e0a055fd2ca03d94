"""The figure of a plain sweep, as SVG text."""

from __future__ import annotations

from rr_opt.report.figures.style import figure, styled, svg
from rr_opt.report.figures.sweep import sweep
from rr_opt.verify.sweep import Gaits


def draw(gaits: Gaits) -> str:
    """Draw the sweep. Many dots are drawn as one picture inside the SVG, to keep it small."""
    with styled():
        drawn = figure(6.8, 4.8)
        ax = sweep(drawn.add_subplot(), gaits)
        for part in (*ax.collections, *ax.lines[:1]):
            part.set_rasterized(len(gaits) > 2000)
        drawn.set_dpi(160)
        return svg(drawn)
