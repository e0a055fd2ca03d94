"""v(1 s)/v(2 s): what viscous friction gives, and what the tables say."""

from __future__ import annotations

from matplotlib.figure import Figure

from rr_opt.paper.period_law import PeriodLaw
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK, figure


def period_law_figure(law: PeriodLaw) -> Figure:
    """The ratio over amplitude, rad, on a logarithmic axis."""
    drawn = figure(6.6, 4.2)
    ax = drawn.subplots()
    viscous = law.spreads[0]
    ax.axhspan(viscous.q05, viscous.q95, color=FORWARD, alpha=0.25, lw=0,
               label="viscous friction, 90 % of robots")  # fmt: skip
    ax.axhline(viscous.largest, color=FORWARD, lw=0.9, ls=":", label="the largest of them")
    for i, one in enumerate(law.ratios):
        ax.plot([one.amplitude] * 2, [one.low, one.high], color=INK, lw=1.4,
                label="mean column, 95 %" if i == 0 else None)  # fmt: skip
        ax.plot(one.amplitude, one.mean, "o", color=INK, ms=7)
        ax.plot(one.amplitude, one.other, "x", color=BACKWARD, ms=9, mew=2,
                label="v_exp column" if i == 0 else None)  # fmt: skip
    ax.set_yscale("log")
    ax.set_yticks([0.5, 1, 2, 4, 8, 16], ["0.5", "1", "2", "4", "8", "16"])
    ax.minorticks_off()
    ax.set_xlim(0.15, 0.9)
    ax.set_xlabel("amplitude α, rad")
    ax.set_ylabel("v(T = 1 s) / v(T = 2 s)")
    ax.set_title("Speed over the period")
    ax.spines["left"].set_color(GREY)
    ax.legend(loc="lower right")
    return drawn
