"""Figures of the audit: signs, readings and the period."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from rr_opt.array import Array
from rr_opt.formatting import number
from rr_opt.results.figures import style
from rr_opt.results.figures.motion import along_travel
from rr_paper.consistency import QUESTIONS, Consistency, Question
from rr_paper.publication import ANGLE_LIMIT, RATE_LIMIT, Row
from rr_paper.reproduction import Reproduction
from rr_paper.signs import CORRECTED, PRINTED, Comparison
from rr_paper.statements import PeriodLaw, Turning
from rr_paper.tables import AMPLITUDES, RecomputedRow, SpeedSurface, Start, Tables

_LINES = {
    "Kane": ("Kane's method", style.FORWARD, 5.0, "-"),
    "multipliers": ("two bodies, multipliers", style.OPTIMUM, 2.4, "-"),
    CORRECTED.name: ("(3) with corrected signs", style.INK, 1.2, (0, (4, 3))),
    PRINTED.name: ("(3) as printed", style.BACKWARD, 1.8, "-"),
}


def signs_figure(motion: Comparison) -> Figure:
    """v of axle 1 over time, mm/s: three lines that coincide, and one that does not."""
    drawn = style.figure(6.6, 4.2)
    ax = drawn.subplots()
    for name, (label, colour, width, line) in _LINES.items():
        ax.plot(motion.t, 1e3 * motion.v[name], color=colour, lw=width, ls=line, label=label)
    ax.set(title="Speed of axle 1 from rest", xlabel="time, s", ylabel="v, mm/s")
    ax.legend(loc="upper right", ncols=2)
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.35 * (high - low))
    return drawn


_PREFIXES: dict[Question, str] = {"ratio": "J20/J10 ", "kappa": "κ = ", "equation": ""}


def readings_figure(found: Consistency) -> Figure:
    """Chi-square of every reading on both columns, on a logarithmic axis."""
    drawn = style.figure(10.4, 4.6)
    ax = drawn.subplots()
    names: list[str] = []
    for question in QUESTIONS:
        pairs = zip(found.of(question, "mean"), found.of(question, "other"), strict=True)
        for mean, other in pairs:
            place = len(names)
            names.append(_PREFIXES[question] + mean.name)
            ax.plot([mean.fit.chi2, other.fit.chi2], [place] * 2, color=style.GREY, lw=0.8)
            for one, marker, colour, shift in (
                (mean, "o", style.FORWARD, 6), (other, "x", style.BACKWARD, -13),
            ):  # fmt: skip
                ax.plot(one.fit.chi2, place, marker, color=colour, ms=8, mew=2)
                ax.annotate(f"p {one.p:.2g}", (one.fit.chi2, place), (0, shift), fontsize=7.5,
                            textcoords="offset points", ha="center", color=colour)  # fmt: skip
    ax.axvline(found.still["mean"], color=style.GREY, lw=1.0, ls=":")
    ax.annotate("a robot that does not move", (found.still["mean"], -0.6), (-4, 0), fontsize=8.5,
                textcoords="offset points", ha="right", color=style.GREY)  # fmt: skip
    ax.plot([], [], "o", color=style.FORWARD, label="mean column")
    ax.plot([], [], "x", color=style.BACKWARD, mew=2, label="v_exp column")
    ax.set_yticks(range(len(names)), names)
    ax.grid(axis="y", visible=False)
    ax.set(xscale="log", ylim=(len(names) - 0.4, -0.9),
           xlabel="remaining chi-square, in standard errors from three runs",
           title="The nine averages cannot tell the readings apart")  # fmt: skip
    ax.legend(loc="upper center", bbox_to_anchor=(0.62, 0.62))
    return drawn


def period_law_figure(law: PeriodLaw) -> Figure:
    """The ratio over amplitude, rad, on a logarithmic axis."""
    drawn = style.figure(6.6, 4.2)
    ax = drawn.subplots()
    viscous = law.spreads[0]
    ax.axhspan(viscous.q05, viscous.q95, color=style.FORWARD, alpha=0.25, lw=0,
               label="viscous friction, 90 % of robots")  # fmt: skip
    ax.axhline(viscous.largest, color=style.FORWARD, lw=0.9, ls=":", label="the largest of these")
    for i, one in enumerate(law.ratios):
        ax.plot([one.amplitude] * 2, [one.low, one.high], color=style.INK, lw=1.4,
                label="mean column, 95 %" if i == 0 else None)  # fmt: skip
        ax.plot(one.amplitude, one.mean, "o", color=style.INK, ms=7)
        ax.plot(one.amplitude, one.other, "x", color=style.BACKWARD, ms=9, mew=2,
                label="v_exp column" if i == 0 else None)  # fmt: skip
    ax.set_yscale("log")
    ax.set_yticks([0.5, 1, 2, 4, 8, 16], ["0.5", "1", "2", "4", "8", "16"])
    ax.minorticks_off()
    ax.set(xlim=(0.15, 0.9), xlabel="amplitude α, rad", ylabel="v(T = 1 s) / v(T = 2 s)",
           title="Speed against period")  # fmt: skip
    ax.spines["left"].set_color(style.GREY)
    ax.legend(loc="lower right")
    return drawn


_THREE = (style.FORWARD, style.PLATFORM1, style.BACKWARD)
"""Colours of three rows or circles."""
_SHIFT = 0.02
"""Offset between rows that would coincide, rad."""


def draw(found: Reproduction) -> dict[str, str]:
    """All figures as SVG texts by name."""
    singular = found.posture.angle
    drawn = {
        "figure3": start_figure(found.start),
        "figure4": ratio_figure(found.ratio_surface, found.tables, singular),
        "figure5": period_figure(found.period_surface, found.tables, singular),
        "figure6": circles_figure(found.turning),
        "signs": signs_figure(found.signs.comparison),
        "readings": readings_figure(found.consistency),
        "period": period_law_figure(found.period),
    }
    return {name: style.svg(one) for name, one in drawn.items()}


def start_figure(start: Start) -> Figure:
    """The path of P, m; and the displacement over a sliding period, per second."""
    drawn = style.figure(6.6, 6.4)
    path, speed = drawn.subplots(2, 1, height_ratios=[1, 1.6])
    moved = along_travel(start.driven)
    path.plot(moved.x, moved.y, color=style.colour_of(start.steady), lw=1.1)
    path.set(title="Path of P from rest", xlabel="x, m", ylabel="y, m")
    row = start.row
    speed.axhspan(
        1e3 * (row.mean - row.half_width), 1e3 * (row.mean + row.half_width), color=style.GREY,
        alpha=0.16, lw=0, label="measured, 95 % interval (Table 3)",
    )  # fmt: skip
    speed.axhline(1e3 * row.mean, color=style.GREY, lw=1.2, label="its mean")
    speed.axhline(1e3 * row.other, color=style.LIMIT, lw=1.2, ls=(0, (4, 2)), label="column v_exp")
    speed.plot(
        start.t, 1e3 * start.speed, color=style.colour_of(start.steady), label="model from rest"
    )
    speed.axhline(1e3 * abs(start.steady), color=style.INK, lw=1.0, ls=":", label="model, steady")
    speed.set(title="Average speed over a period", xlabel="time, s", ylabel="mm/s",
              xlim=(0, start.driven.t[-1]), ylim=(0, 1.1e3 * (row.mean + row.half_width))
    )  # fmt: skip
    gait = start.gait
    style.note(
        speed, f"α = {number(gait.amplitude)} rad, T = {number(gait.period)} s, "
        f"J20/J10 = {number(row.ratio)}; the paper gives none for Fig. 3", y=0.06, va="bottom",
    )  # fmt: skip
    speed.legend(loc="lower right", bbox_to_anchor=(1.0, 0.14))
    return drawn


def ratio_figure(surface: SpeedSurface, tables: Tables, singular: float) -> Figure:
    """The map, with Table 2's fitted amplitude; and its rows over all amplitudes."""
    drawn = style.figure(11.4, 4.9)
    left, right = drawn.subplots(1, 2, width_ratios=[1.1, 1])
    norm = _speed_map(left, surface, surface.ratio, singular)
    left.set_xlabel("J20/J10 (about P), T = 1 s")
    points = [(one.row.ratio, one.amplitude, one.row) for one in tables.table2]
    _measured_means(left, points, norm, stacked=False)
    for i, (one, speed) in enumerate(zip(tables.table2, tables.speeds, strict=True)):
        row, size, colour = one.row, 1e3 * np.abs(speed), _THREE[i]
        inside = np.abs(np.abs(speed) - row.mean) <= row.half_width
        right.plot(AMPLITUDES, size, color=colour, lw=1.0)
        right.plot(AMPLITUDES, np.where(inside, size, np.nan), color=colour, lw=4, alpha=0.5)
        label = f"J20/J10 = {number(row.ratio)}"
        _printed_row(right, one.amplitude + _SHIFT * (i - 1), row, colour, label)
    limit = RATE_LIMIT / (2 * np.pi)
    right.axvline(limit, color=style.LIMIT, lw=1.4)
    right.annotate("30 rpm", (limit, 0.98), xycoords=("data", "axes fraction"), color=style.LIMIT,
                   ha="right", va="top", rotation=90, fontsize=9)  # fmt: skip
    right.set_ylim(0, None)
    right.set(xlabel="amplitude α, rad (not given in Table 2)", ylabel="|mean speed|, mm/s",
              title="Table 2: dots mean, crosses v_exp, lines model")  # fmt: skip
    right.legend(title="thick: within the interval", loc="lower right")
    return drawn


def period_figure(surface: SpeedSurface, tables: Tables, singular: float) -> Figure:
    """The map with the six measured means; and cuts through it at their two periods."""
    drawn = style.figure(11.4, 4.9)
    left, right = drawn.subplots(1, 2, width_ratios=[1.1, 1])
    norm = _speed_map(left, surface, surface.period, singular)
    left.set_xlabel("period T, s, at J20/J10 = 0.3 (about P)")
    points = [(one.row.period, one.amplitude, one.row) for one in tables.table3]
    _measured_means(left, points, norm, stacked=True)
    for period, colour in ((1.0, style.FORWARD), (2.0, style.BACKWARD)):
        rows = [one for one in tables.table3 if one.row.period == period]
        _cut(right, surface, rows, period, colour)
    right.set_yscale("log")
    right.set(xlim=(0.15, surface.amplitude[-1]), ylim=(2, 1000), xlabel="amplitude α, rad",
              ylabel="|mean speed|, mm/s", title="Table 3: dots mean, crosses v_exp, lines model"
    )  # fmt: skip
    right.legend(loc="lower right")
    return drawn


def _speed_map(ax: Axes, surface: SpeedSurface, across: Array, singular: float) -> TwoSlopeNorm:
    """Filled contours over `across` (the ratio or the period) and amplitude.

    singular: the angle of the singular posture, rad. Returns the colour norm of the speed.
    """
    speed = 1e3 * surface.speed
    top = max(float(abs(speed).max()), 1e-9)
    norm = TwoSlopeNorm(0.0, -top, top)
    alpha = surface.amplitude
    fill = ax.contourf(across, alpha, speed, levels=25, cmap=style.SIGNED, norm=norm, zorder=1)
    fill.set(edgecolor="face", linewidth=0.4)
    ax.contour(across, alpha, speed, levels=[0.0], colors=[style.INK], linewidths=0.8, zorder=2)
    rate = surface.rate
    if rate.max() > RATE_LIMIT:
        ax.contourf(
            across, alpha, rate, levels=[RATE_LIMIT, 2 * rate.max()],
            colors=[(1, 1, 1, 0.35)], hatches=["////"], zorder=3,
        )  # fmt: skip
        ax.contour(across, alpha, rate, levels=[RATE_LIMIT], colors=[style.LIMIT], linewidths=1.6,
                   zorder=4)  # fmt: skip
    bar = ax.figure.colorbar(fill, ax=ax, pad=0.02, aspect=30, ticks=MaxNLocator(7))
    bar.set_label("mean speed, mm/s  (−: platform 2 leads)")
    bar.outline.set_visible(False)  # type: ignore[operator]
    ax.grid(False)
    ax.set(ylabel="amplitude α, rad", title="Hatched: above 30 rpm")
    ax.annotate(
        f"Above the plot: singular posture at {number(singular, 3)} rad, servo limit at "
        f"{number(ANGLE_LIMIT)} rad", (0, -0.2), xycoords="axes fraction", fontsize=8.5,
        color=style.GREY,
    )  # fmt: skip
    return norm


def _measured_means(
    ax: Axes, points: Sequence[tuple[float, float, Row]], norm: TwoSlopeNorm, *, stacked: bool
) -> None:
    """Measured means in the colour of their speed, with their intervals.

    The tables give no sign; the model's is used. stacked: points are above one another; else their
    numbers alternate above and below them.
    """
    for i, (x, y, row) in enumerate(points):
        above = stacked or i % 2 == 0
        colour = style.SIGNED(norm(-1e3 * row.mean))
        ax.plot(x, y, "o", ms=11, mfc=colour, mec=style.INK, mew=1.3, zorder=6, clip_on=False)
        text = f"{number(1e3 * row.mean, 3)} ± {number(1e3 * row.half_width, 3)}"
        ax.annotate(
            text, (x, y), (0, 9 if above else -17), textcoords="offset points", fontsize=8.5,
            zorder=7, ha="right" if x > 0.9 * ax.get_xlim()[1] else "center",
            path_effects=[withStroke(linewidth=3, foreground=style.PAPER, alpha=0.9)],
        )  # fmt: skip


def _printed_row(ax: Axes, x: float, row: Row, colour: str, label: str | None = None) -> None:
    """A row's mean with its interval, and its v_exp, mm/s."""
    ax.errorbar(x, 1e3 * row.mean, 1e3 * row.half_width, fmt="o", color=colour, capsize=3,
                label=label, zorder=5)  # fmt: skip
    ax.plot(x, 1e3 * row.other, "x", color=colour, ms=8, mew=2, zorder=5)


def _cut(
    ax: Axes, surface: SpeedSurface, rows: list[RecomputedRow], period: float, colour: str
) -> None:
    """The model at one period, broken beyond 30 rpm, with the measurements."""
    alpha = surface.amplitude
    speed = 1e3 * np.abs(surface.speed[:, int(np.abs(surface.period - period).argmin())])
    kept = 2 * np.pi * alpha / period <= RATE_LIMIT
    label = f"T = {number(period)} s"
    ax.plot(alpha, np.where(kept, speed, np.nan), color=colour, label=label)
    ax.plot(alpha, np.where(kept, np.nan, speed), color=colour, ls=(0, (3, 2)),
            label=f"{label}, above 30 rpm" if not kept.all() else None)  # fmt: skip
    for one in rows:
        _printed_row(ax, one.amplitude, one.row, colour)
    ax.axvline(RATE_LIMIT * period / (2 * np.pi), color=style.LIMIT, lw=0.8, ls=":")


def circles_figure(turning: Turning) -> Figure:
    """The paths of P, m, each beginning at the origin with platform 1 along x."""
    drawn = style.figure(6.6, 6.0)
    ax = drawn.subplots()
    for one, colour in zip(turning.circles, _THREE, strict=True):
        label = f"φ0 = {number(one.gait.offset, 3)}: R = {number(one.circle.radius, 3)} m"
        ax.plot(one.driven.x, one.driven.y, color=colour, lw=1.0, label=label)
    ax.plot(0, 0, "o", color=style.INK, ms=5, zorder=5)
    gait = turning.circles[0].gait
    ax.set_title(f"Circles at α = {number(gait.amplitude)} rad, T = {number(gait.period)} s")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="x, m", ylabel="y, m")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 0.14))
    return drawn
