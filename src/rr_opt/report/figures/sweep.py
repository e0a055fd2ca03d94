"""Every gait of a sweep: its speed over period and amplitude, the best one marked."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.ticker import MaxNLocator

from rr_opt.report.figures.style import GREY, INK, OPTIMUM, SIGNED, note
from rr_opt.verify.sweep import Gaits


def sweep(ax: Axes, gaits: Gaits) -> Axes:
    """A dot a gait, the fastest drawn last; crosses for gaits that break a limit.

    Gaits of several offsets and inertia ratios share a place: what is seen is the fastest.
    """
    speed = 1e3 * gaits.speed
    kept = gaits.allowed & np.isfinite(speed)
    ax.plot(gaits.period[~kept], gaits.amplitude[~kept], "x", color=GREY, ms=2.5, mew=0.6)
    order = np.flatnonzero(kept)
    order = order[np.argsort(np.abs(speed[order]))]
    top = float(np.abs(speed[order[-1]])) if len(order) else 1.0
    size = min(max(9000.0 / max(len(gaits), 1), 4.0), 40.0)
    dots = ax.scatter(
        gaits.period[order],
        gaits.amplitude[order],
        c=speed[order],
        cmap=SIGNED,
        norm=TwoSlopeNorm(0.0, -top, top),
        s=size,
        edgecolors=GREY,
        linewidths=0.15,
        zorder=3,
    )
    bar = ax.figure.colorbar(dots, ax=ax, pad=0.02, aspect=26, ticks=MaxNLocator(7))
    bar.set_label("mean speed, mm/s  (+ forward, − backward)")
    bar.outline.set_visible(False)  # type: ignore[operator]
    best = gaits.best()
    if best is not None:
        at = gaits.gait(best)
        ax.plot(
            at.period, at.amplitude, "*", ms=19, mfc=OPTIMUM, mec=INK, mew=1.2, zorder=5,
            clip_on=False,
        )  # fmt: skip
    note(ax, f"{len(gaits)} gaits, {int(kept.sum())} allowed", x=0.015, ha="left")
    ax.set_xlabel("period T, s")
    ax.set_ylabel("amplitude α, rad")
    return ax
