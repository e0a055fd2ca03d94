"""Figures of the audit: signs, readings and the period."""

from __future__ import annotations

from matplotlib.figure import Figure

from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK, OPTIMUM, figure
from rr_paper.consistency import QUESTIONS, Consistency, Question
from rr_paper.equation3 import CORRECTED, PRINTED
from rr_paper.period import PeriodLaw
from rr_paper.signs import Comparison

_LINES = {
    "Kane": ("Kane's method", FORWARD, 5.0, "-"),
    "multipliers": ("two bodies, multipliers", OPTIMUM, 2.4, "-"),
    CORRECTED.name: ("(3) with corrected signs", INK, 1.2, (0, (4, 3))),
    PRINTED.name: ("(3) as printed", BACKWARD, 1.8, "-"),
}


def signs_figure(motion: Comparison) -> Figure:
    """v of axle 1 over time, mm/s: three lines that coincide, and one that does not."""
    drawn = figure(6.6, 4.2)
    ax = drawn.subplots()
    for name, (label, colour, width, line) in _LINES.items():
        ax.plot(motion.t, 1e3 * motion.v[name], color=colour, lw=width, ls=line, label=label)
    ax.set_title("Speed of axle 1 from rest")
    ax.set_xlabel("time, s")
    ax.set_ylabel("v, mm/s")
    ax.legend(loc="upper right", ncols=2)
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.35 * (high - low))
    return drawn


_PREFIXES: dict[Question, str] = {"ratio": "J20/J10 ", "kappa": "κ = ", "equation": ""}


def readings_figure(found: Consistency) -> Figure:
    """Chi-square of every reading on both columns, on a logarithmic axis."""
    drawn = figure(10.4, 4.6)
    ax = drawn.subplots()
    names: list[str] = []
    for question in QUESTIONS:
        pairs = zip(found.of(question, "mean"), found.of(question, "other"), strict=True)
        for mean, other in pairs:
            place = len(names)
            names.append(_PREFIXES[question] + mean.name)
            ax.plot([mean.fit.chi2, other.fit.chi2], [place] * 2, color=GREY, lw=0.8)
            for one, marker, colour, shift in (
                (mean, "o", FORWARD, 6), (other, "x", BACKWARD, -13),
            ):  # fmt: skip
                ax.plot(one.fit.chi2, place, marker, color=colour, ms=8, mew=2)
                ax.annotate(f"p {one.p:.2g}", (one.fit.chi2, place), (0, shift), fontsize=7.5,
                            textcoords="offset points", ha="center", color=colour)  # fmt: skip
    ax.axvline(found.still["mean"], color=GREY, lw=1.0, ls=":")
    ax.annotate("a robot that stands still", (found.still["mean"], -0.6), (-4, 0), fontsize=8.5,
                textcoords="offset points", ha="right", color=GREY)  # fmt: skip
    ax.plot([], [], "o", color=FORWARD, label="mean column")
    ax.plot([], [], "x", color=BACKWARD, mew=2, label="v_exp column")
    ax.set_xscale("log")
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.4, -0.9)
    ax.grid(axis="y", visible=False)
    ax.set_xlabel("chi-square left, in standard errors of three runs")
    ax.set_title("Nine averages cannot distinguish the readings")
    ax.legend(loc="upper center", bbox_to_anchor=(0.62, 0.62))
    return drawn


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
