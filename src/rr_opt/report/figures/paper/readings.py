"""How well each reading fits the nine averages."""

from __future__ import annotations

from matplotlib.figure import Figure

from rr_opt.paper.consistency import QUESTIONS, Consistency, Question
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, figure

_HEADS: dict[Question, str] = {"ratio": "J20/J10 ", "kappa": "κ = ", "equation": ""}


def readings_figure(found: Consistency) -> Figure:
    """Chi-square of every reading on both columns, on a logarithmic axis."""
    drawn = figure(10.4, 4.6)
    ax = drawn.subplots()
    names: list[str] = []
    for question in QUESTIONS:
        for mean, other in zip(found.of(question, "mean"), found.of(question, "other"),
                               strict=True):  # fmt: skip
            place = len(names)
            names.append(_HEADS[question] + mean.name)
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
    ax.set_title("Nine averages do not tell readings apart")
    ax.legend(loc="upper center", bbox_to_anchor=(0.62, 0.62))
    return drawn
