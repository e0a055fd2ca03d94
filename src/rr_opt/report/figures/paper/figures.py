"""All figures of the reproduction, as SVG texts by name."""

from __future__ import annotations

from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.figures.paper.circles import circles_figure
from rr_opt.report.figures.paper.period_law import period_law_figure
from rr_opt.report.figures.paper.period_surface import period_surface_figure
from rr_opt.report.figures.paper.ratio_surface import ratio_surface_figure
from rr_opt.report.figures.paper.readings import readings_figure
from rr_opt.report.figures.paper.signs import signs_figure
from rr_opt.report.figures.paper.start import start_figure
from rr_opt.report.figures.style import styled, svg


def draw(found: Reproduction) -> dict[str, str]:
    """The figures."""
    singular = found.posture.angle
    with styled():
        drawn = {
            "figure3": start_figure(found.start),
            "figure4": ratio_surface_figure(found.ratio_surface, found.tables, singular),
            "figure5": period_surface_figure(found.period_surface, found.tables, singular),
            "figure6": circles_figure(found.turning),
            "signs": signs_figure(found.signs.driven),
            "readings": readings_figure(found.consistency),
            "period": period_law_figure(found.period),
        }
        return {name: svg(one) for name, one in drawn.items()}
