"""Every gait of a sweep: its speed over period and amplitude, the best one marked."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.ticker import MaxNLocator

from rr_opt.report.figures.style import GREY, INK, OPTIMUM, SIGNED
from rr_opt.verify.evaluate import Evaluated, Found


def sweep(ax: Axes, found: Evaluated, best: Found | None) -> Axes:
    """A dot a gait that keeps every limit, the fastest on top; a faint cross any other.

    Gaits of several offsets and inertia ratios share a place: what is seen is the fastest.
    """
    amplitude, period = found.decisions[:2]
    speed, kept = 1e3 * found.speed, found.feasible
    ax.plot(period[~kept], amplitude[~kept], "x", color=GREY, ms=2.5, mew=0.5, alpha=0.3)
    order = np.flatnonzero(kept)
    order = order[np.argsort(np.abs(speed[order]))]
    top = float(np.abs(speed[order[-1]])) if len(order) else 1.0
    dots = ax.scatter(
        period[order],
        amplitude[order],
        c=speed[order],
        cmap=SIGNED,
        norm=TwoSlopeNorm(0.0, -top, top),
        s=26,
        edgecolors=GREY,
        linewidths=0.25,
        zorder=3,
    )
    bar = ax.figure.colorbar(dots, ax=ax, pad=0.02, aspect=26, ticks=MaxNLocator(7))
    bar.set_label("mean speed, mm/s  (+ forward, − backward)")
    seen = speed[order]
    bar.ax.set_ylim(min(seen.min(initial=0.0), -1e-9), max(seen.max(initial=0.0), 1e-9))
    bar.outline.set_visible(False)  # type: ignore[operator]
    if best:
        star = {"ms": 19, "mfc": OPTIMUM, "mec": INK, "mew": 1.2}
        ax.plot(best.gait.period, best.gait.amplitude, "*", zorder=5, clip_on=False, **star)
    ax.set_title(f"{len(speed)} gaits: dots keep every limit, crosses do not", weight="normal")
    ax.set_xlabel("period T, s")
    ax.set_ylabel("amplitude α, rad")
    return ax
