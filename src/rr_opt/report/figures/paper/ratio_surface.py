"""Beside Fig. 4: average speed over J20/J10 and amplitude, and Table 2 whose amplitude is open."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rr_opt.paper.surfaces import RATE_LIMIT, SpeedSurface
from rr_opt.paper.tables import AMPLITUDES, Tables
from rr_opt.report.figures.paper.surface import marked, surface
from rr_opt.report.figures.style import BACKWARD, FORWARD, LIMIT, PLATFORM1, figure
from rr_opt.report.quantities import number

_COLOURS = (FORWARD, PLATFORM1, BACKWARD)
_APART = 0.02
"""Between rows that would hide one another, rad."""


def ratio_surface_figure(found: SpeedSurface, tables: Tables, singular: float) -> Figure:
    """The map, with Table 2's amplitude as found; and its rows over all amplitudes."""
    drawn = figure(11.4, 4.9)
    left, right = drawn.subplots(1, 2, width_ratios=[1.1, 1])
    norm = surface(left, found, found.ratio, singular)
    left.set_xlabel("J20/J10 (about P), T = 1 s")
    marked(left, [(o.row.ratio, o.amplitude, o.row) for o in tables.table2], norm, stacked=False)
    _rows(right, tables)
    return drawn


def _rows(ax: Axes, tables: Tables) -> None:
    """|speed| over amplitude for each row, thick where it is within the row's interval."""
    for i, (one, speed) in enumerate(zip(tables.table2, tables.speeds, strict=True)):
        colour, at = _COLOURS[i], one.amplitude + _APART * (i - 1)
        row, size = one.row, 1e3 * np.abs(speed)
        near = np.abs(np.abs(speed) - row.mean) <= row.half_width
        ax.plot(AMPLITUDES, size, color=colour, lw=1.0)
        ax.plot(AMPLITUDES, np.where(near, size, np.nan), color=colour, lw=4, alpha=0.5)
        ax.errorbar(
            at, 1e3 * row.mean, 1e3 * row.half_width, fmt="o", color=colour, capsize=3,
            label=f"J20/J10 = {number(row.ratio)}", zorder=5,
        )  # fmt: skip
        ax.plot(at, 1e3 * row.other, "x", color=colour, ms=8, mew=2, zorder=5)
    limit = RATE_LIMIT / (2 * np.pi)
    ax.axvline(limit, color=LIMIT, lw=1.4)
    ax.annotate("30 rpm", (limit, 0.98), xycoords=("data", "axes fraction"), color=LIMIT,
                ha="right", va="top", rotation=90, fontsize=9)  # fmt: skip
    ax.set_ylim(0, None)
    ax.set_xlabel("amplitude α, rad (Table 2 does not give it)")
    ax.set_ylabel("|mean speed|, mm/s")
    ax.set_title("Table 2: dot mean, cross v_exp, line model")
    ax.legend(title="thick: within the interval", loc="lower right")
