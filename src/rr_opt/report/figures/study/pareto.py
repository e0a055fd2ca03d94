"""What speed costs: every case's speed over its torque or energy, and the front of the best."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from rr_opt.report.figures.style import BACKWARD, FORWARD, INK, OPTIMUM
from rr_opt.report.study.result import Studied, front


def pareto(ax: Axes, result: Studied, name: str, label: str) -> Axes:
    """A dot a case, blue forward and orange backward; ringed, on the line: no other case is both
    faster and cheaper. name: the number of the optimum that is the cost."""
    cost, speed = result.values(name), 1e3 * result.speed
    forward = result.values("speed") > 0
    for way, colour, word in ((forward, FORWARD, "forward"), (~forward, BACKWARD, "backward")):
        some = way & np.isfinite(speed)
        if some.any():
            ax.plot(cost[some], speed[some], "o", ms=5, mec="none", color=colour, alpha=0.45,
                    label=word)  # fmt: skip
    best = front(cost, speed)
    ax.plot(cost[best], speed[best], drawstyle="steps-post", color=INK, lw=1.2, zorder=3)
    ax.plot(cost[best], speed[best], "o", ms=7, mfc=OPTIMUM, mec=INK, mew=1.0, zorder=4,
            label="front")  # fmt: skip
    if np.nanmax(cost) > 20 * np.nanmin(cost) > 0:
        ax.set_xscale("log")
        ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_locator(NullLocator())
    ax.set_ylim(0, 1.06 * np.nanmax(speed))
    ax.set_xlabel(label)
    ax.set_ylabel("speed, mm/s")
    ax.legend(loc="best")
    return ax
