"""Beside Fig. 6: the three circles, from rest and once round."""

from __future__ import annotations

from matplotlib.figure import Figure

from rr_opt.paper.turning import Turning
from rr_opt.report.figures.style import BACKWARD, FORWARD, INK, PLATFORM1, figure
from rr_opt.report.quantities import number

_COLOURS = (FORWARD, PLATFORM1, BACKWARD)


def circles_figure(turning: Turning) -> Figure:
    """The paths of P, m, each beginning at the origin with platform 1 along x."""
    drawn = figure(6.6, 6.0)
    ax = drawn.subplots()
    for one, colour in zip(turning.circles, _COLOURS, strict=True):
        label = f"φ0 = {number(one.gait.offset, 3)}: R = {number(one.circle.radius, 3)} m"
        ax.plot(one.driven.x, one.driven.y, color=colour, lw=1.0, label=label)
    ax.plot(0, 0, "o", color=INK, ms=5, zorder=5)
    gait = turning.circles[0].gait
    ax.set_title(f"Circles at α = {number(gait.amplitude)} rad, T = {number(gait.period)} s")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel("x, m")
    ax.set_ylabel("y, m")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 0.14))
    return drawn
