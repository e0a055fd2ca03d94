"""What is left of the markers when two rigid platforms are fitted to them."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rr_opt.recordings.from_markers import MarkerFit
from rr_opt.report.figures.inspect.thinned import thinned
from rr_opt.report.figures.style import BACKWARD, FORWARD, INK, LIMIT, PLATFORM1, PLATFORM2

_CUT = 8.0
"""Times the noise at which the axis ends, if something is beyond."""


def over_time(ax: Axes, fit: MarkerFit) -> Axes:
    """Root mean square residual of each frame, mm; put right and left out frames marked below."""
    t = fit.recording.t
    ax.plot(*thinned(t, 1e3 * fit.residual), color=INK, lw=0.7)
    swapped = np.unique(np.concatenate([[], *(swap.frames for swap in fit.swaps)])).astype(int)
    ghosts = np.flatnonzero(fit.ghosts.out.any(axis=1))
    marked = (
        (swapped, "names put right", FORWARD, 0.02),
        (ghosts, "marker left out", BACKWARD, 0.05),
        (fit.ghosts.lost, "does not fit", LIMIT, 0.08),
    )
    for rows, words, colour, height in marked:
        if len(rows):
            ax.plot(t[rows], np.full(len(rows), height), "|", color=colour, ms=6, label=words,
                    transform=ax.get_xaxis_transform())  # fmt: skip
    if ax.get_legend_handles_labels()[0]:
        ax.legend(loc="upper right", ncols=3)
    if np.isfinite(fit.noise) and fit.noise > 0:
        largest = float(np.nanmax(fit.residual))
        ax.set_ylim(0, 1e3 * min(1.1 * largest, _CUT * fit.noise))
    ax.set_xlim(t[0], t[-1])
    ax.set_xlabel("time, s")
    ax.set_ylabel("residual, mm")
    return ax


def by_marker(ax: Axes, fit: MarkerFit) -> Axes:
    """Root mean square residual of each marker, mm."""
    colours = [(PLATFORM1, PLATFORM2)[where] for where in fit.bodies.platform]
    rows = np.arange(len(fit.whose))
    ax.barh(rows, 1e3 * np.nan_to_num(fit.whose), color=colours, height=0.6)
    ax.set_yticks(rows, fit.bodies.labels)
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")
    ax.set_xlabel("residual, mm")
    return ax
