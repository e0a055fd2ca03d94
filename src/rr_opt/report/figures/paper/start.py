"""Beside Fig. 3: a start from rest, its path and its average speed."""

from __future__ import annotations

from matplotlib.figure import Figure

from rr_opt.paper.start import Start
from rr_opt.report.figures.path import along_travel
from rr_opt.report.figures.style import GREY, INK, LIMIT, colour_of, figure, note
from rr_opt.report.quantities import number


def start_figure(start: Start) -> Figure:
    """(a) the path of P, m; (b) the displacement over a sliding period, per second."""
    drawn = figure(6.6, 6.4)
    path, speed = drawn.subplots(2, 1, height_ratios=[1, 1.6])
    moved = along_travel(start.driven)
    path.plot(moved.x, moved.y, color=colour_of(start.steady), lw=1.1)
    path.set_title("Path of P from rest")
    path.set_xlabel("x, m")
    path.set_ylabel("y, m")
    row = start.row
    speed.axhspan(
        1e3 * (row.mean - row.half_width), 1e3 * (row.mean + row.half_width), color=GREY,
        alpha=0.16, lw=0, label="measured, 95 % interval (Table 3)",
    )  # fmt: skip
    speed.axhline(1e3 * row.mean, color=GREY, lw=1.2, label="its mean")
    speed.axhline(1e3 * row.other, color=LIMIT, lw=1.2, ls=(0, (4, 2)), label="column v_exp")
    speed.plot(start.t, 1e3 * start.speed, color=colour_of(start.steady), label="model from rest")
    speed.axhline(1e3 * abs(start.steady), color=INK, lw=1.0, ls=":", label="model, steady")
    speed.set_title("Average speed over a period")
    speed.set_xlabel("time, s")
    speed.set_ylabel("mm/s")
    speed.set_xlim(0, start.driven.t[-1])
    speed.set_ylim(0, 1.1e3 * (row.mean + row.half_width))
    gait = start.gait
    note(
        speed, f"α = {number(gait.amplitude)} rad, T = {number(gait.period)} s, "
        f"J20/J10 = {number(row.ratio)}; the paper does not give Fig. 3's", y=0.06, va="bottom",
    )  # fmt: skip
    speed.legend(loc="lower right", bbox_to_anchor=(1.0, 0.14))
    return drawn
