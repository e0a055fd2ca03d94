"""Which signs of equation (3) mechanics gives: the speed from rest by each."""

from __future__ import annotations

from matplotlib.figure import Figure

from rr_opt.paper.equation3 import CORRECTED, PRINTED
from rr_opt.paper.signs import Driven
from rr_opt.report.figures.style import BACKWARD, FORWARD, INK, OPTIMUM, figure

_LINES = {
    "Kane": ("Kane's method", FORWARD, 5.0, "-"),
    "multipliers": ("two bodies, multipliers", OPTIMUM, 2.4, "-"),
    CORRECTED.name: ("(3) with corrected signs", INK, 1.2, (0, (4, 3))),
    PRINTED.name: ("(3) as printed", BACKWARD, 1.8, "-"),
}


def signs_figure(driven: Driven) -> Figure:
    """v of axle 1 over time, mm/s: three lines that lie on one another, and one that does not."""
    drawn = figure(6.6, 4.2)
    ax = drawn.subplots()
    for name, (label, colour, width, line) in _LINES.items():
        ax.plot(driven.t, 1e3 * driven.v[name], color=colour, lw=width, ls=line, label=label)
    ax.set_title("Speed of axle 1 from rest")
    ax.set_xlabel("time, s")
    ax.set_ylabel("v, mm/s")
    ax.legend(loc="upper right", ncols=2)
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.35 * (high - low))
    return drawn
