"""A sweep: every gait by its period and amplitude, coloured by its speed."""

from __future__ import annotations

import numpy as np

from rr_opt.report.figures import style
from rr_opt.report.figures.speed_map import label
from rr_opt.results.sweep import Sweep

_MANY = 2000


def draw(result: Sweep) -> dict[str, str]:
    """A dot for each gait that respects every limit, the fastest on top; a faint cross for any
    other. Many dots become one picture inside the SVG, to keep it small.

    Gaits of several offsets and inertia ratios share a place: what is seen is the fastest.
    """
    found, best = result.found.found, result.best
    amplitude, period = found.decisions[:2]
    speed, kept = 1e3 * found.speed, found.feasible
    order = np.flatnonzero(kept)
    order = order[np.argsort(np.abs(speed[order]))]
    top = float(np.abs(speed[order[-1]])) if len(order) else 1.0
    with style.styled():
        drawn = style.figure(style.WIDTH, 4.4)
        drawn.set_dpi(160)
        ax = drawn.add_subplot()
        ax.plot(period[~kept], amplitude[~kept], "x", color=style.GREY, ms=2.5, mew=0.5, alpha=0.3)
        dots = ax.scatter(
            period[order], amplitude[order], c=speed[order], cmap=style.SIGNED,
            norm=style.signed(top), s=26, edgecolors=style.GREY, linewidths=0.25, zorder=3,
        )  # fmt: skip
        for part in (*ax.collections, *ax.lines):
            part.set_rasterized(len(speed) > _MANY)
        ends = speed[order].min(initial=0.0), speed[order].max(initial=0.0)
        style.speed_bar(ax, dots).set_ylim(min(ends[0], -1e-9), max(ends[1], 1e-9))
        if best:
            ax.plot(best.gait.period, best.gait.amplitude, ms=19, mew=1.2, zorder=5, **style.STAR)
        ax.set_title(f"{len(speed)} gaits: dots keep every limit, crosses do not", weight="normal")
        label(ax)
        return {"sweep": style.svg(drawn)}
