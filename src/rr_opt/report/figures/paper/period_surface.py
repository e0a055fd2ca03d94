"""Beside Fig. 5: average speed over period and amplitude, and Table 3."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rr_opt.paper.surfaces import RATE_LIMIT, SpeedSurface
from rr_opt.paper.tables import Regenerated, Tables
from rr_opt.report.figures.paper.surface import marked, surface
from rr_opt.report.figures.style import BACKWARD, FORWARD, LIMIT, figure
from rr_opt.report.quantities import number


def period_surface_figure(found: SpeedSurface, tables: Tables, singular: float) -> Figure:
    """The map with the six measured means; and cuts through it at their two periods."""
    drawn = figure(11.4, 4.9)
    left, right = drawn.subplots(1, 2, width_ratios=[1.1, 1])
    norm = surface(left, found, found.period, singular)
    left.set_xlabel("period T, s, at J20/J10 = 0.3 (about P)")
    marked(left, [(o.row.period, o.amplitude, o.row) for o in tables.table3], norm, stacked=True)
    for period, colour in ((1.0, FORWARD), (2.0, BACKWARD)):
        _cut(right, found, [o for o in tables.table3 if o.row.period == period], period, colour)
    right.set_yscale("log")
    right.set_ylim(2, 1000)
    right.set_xlim(0.15, found.amplitude[-1])
    right.set_xlabel("amplitude α, rad")
    right.set_ylabel("|mean speed|, mm/s")
    right.set_title("Table 3: dot mean, cross v_exp, line model")
    right.legend(loc="lower right")
    return drawn


def _cut(
    ax: Axes, found: SpeedSurface, rows: list[Regenerated], period: float, colour: str
) -> None:
    """The model at one period, broken beyond 30 rpm, with what was measured."""
    speed = 1e3 * np.abs(found.speed[:, int(np.abs(found.period - period).argmin())])
    kept = 2 * np.pi * found.amplitude / period <= RATE_LIMIT
    label = f"T = {number(period)} s"
    ax.plot(found.amplitude, np.where(kept, speed, np.nan), color=colour, label=label)
    ax.plot(found.amplitude, np.where(kept, np.nan, speed), color=colour, ls=(0, (3, 2)),
            label=f"{label}, beyond 30 rpm" if not kept.all() else None)  # fmt: skip
    for one in rows:
        row = one.row
        ax.errorbar(one.amplitude, 1e3 * row.mean, 1e3 * row.half_width, fmt="o", color=colour,
                    capsize=3, zorder=5)  # fmt: skip
        ax.plot(one.amplitude, 1e3 * row.other, "x", color=colour, ms=8, mew=2, zorder=5)
    ax.axvline(RATE_LIMIT * period / (2 * np.pi), color=LIMIT, lw=0.8, ls=":")
