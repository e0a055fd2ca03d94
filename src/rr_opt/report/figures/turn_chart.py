"""Radius over offset: a panel for each period, a line for each amplitude."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rr_opt.formatting import with_unit
from rr_opt.report.figures import style
from rr_opt.results.turn_chart import TurnChart
from rr_opt.verify.turn_chart import Tightest, TurnMap

_WIDEST = 20.0
"""m; wider circles are left out of the picture."""


def draw(chart: TurnChart) -> dict[str, str]:
    """The chart as SVG text by its name."""
    with style.styled():
        return {"turn-chart": style.svg(turn_chart(chart.seen, chart.tight))}


def turn_chart(seen: TurnMap, tight: Tightest | None) -> Figure:
    """All panels; offsets below 0 are the mirror image and not drawn."""
    count = len(seen.period)
    columns = min(count, 2)
    drawn = style.figure(style.WIDTH, 1.0 + 2.3 * -(-count // columns))
    axes = drawn.subplots(-(-count // columns), columns, sharex=True, sharey=True, squeeze=False)
    for j, ax in enumerate(axes.flat):
        if j >= count:
            ax.set_visible(False)
            continue
        _panel(ax, seen, j)
        if tight:
            ax.axhline(tight.radius, color=style.LIMIT, lw=1.0)
    style.note(axes[0, 0], "solid: to the left, dashed: to the right")
    if tight:
        style.note(
            axes[0, 0], f"tightest: {with_unit(tight.radius, 'm')}", y=0.1, color=style.LIMIT
        )
    for ax in axes[-1]:
        ax.set_xlabel("offset φ0, rad")
    for ax in axes[:, 0]:
        ax.set_ylabel("radius, m")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", ncols=4, title="amplitude α")
    return drawn


def _panel(ax: Axes, seen: TurnMap, j: int) -> None:
    """Solid lines turn left, dashed ones right; blank where a limit is exceeded."""
    colours = mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(seen.amplitude)))
    curvature = seen.curvature[:, j]
    kept = seen.keeps[:, j] & (np.abs(curvature) > 1 / _WIDEST)
    for i, alpha in enumerate(seen.amplitude):
        label = with_unit(float(alpha), "rad", 3)
        ax.plot([], [], color=colours[i], label=label)
        for side, line in ((1, "-"), (-1, "--")):
            there = kept[i] & (side * curvature[i] > 0)
            radius = np.full(len(seen.offset), np.nan)
            radius[there] = 1 / np.abs(curvature[i][there])
            ax.plot(seen.offset, radius, line, color=colours[i], lw=1.5)
    ax.set(yscale="log", title=f"T = {with_unit(float(seen.period[j]), 's', 3)}")
