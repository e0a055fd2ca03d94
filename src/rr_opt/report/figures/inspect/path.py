"""The joint's path over the floor."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from rr_opt.experiment.recording import Recording
from rr_opt.report.figures.style import GREY, INK, OPTIMUM

_ARROWS = 6


def path(ax: Axes, recording: Recording) -> Axes:
    """P, m, with a dot where it starts, and arrows of platform 1's heading, towards its axle."""
    x, y, psi = (recording.data(channel) for channel in ("x", "y", "psi"))
    step = max(1, len(x) // 4000)
    ax.plot(x[::step], y[::step], color=INK, lw=1.2)
    known = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    headed = known[np.isfinite(psi[known])]
    if len(known):
        first = known[0]
        ax.plot(x[first], y[first], "o", ms=8, color=OPTIMUM, mec=INK, zorder=4, label="start")
        ax.legend(loc="best")
    rows = headed[np.linspace(0, len(headed) - 1, min(_ARROWS, len(headed))).astype(int)]
    ax.quiver(
        x[rows], y[rows], np.cos(psi[rows]), np.sin(psi[rows]),
        color=GREY, width=0.004, scale=14, zorder=3,
    )  # fmt: skip
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.1)
    ax.set_xlabel("x, m")
    ax.set_ylabel("y, m")
    return ax
