"""phi against its command: folded over a period, and the difference over time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.report.figures.inspect.thinned import thinned
from rr_opt.report.figures.style import FORWARD, GREY, INK, note
from rr_opt.robot.gait import Gait

_POINTS = 1000
_DOT = 2e-4
"""Half the length of a dot, in periods."""


def folded(
    ax: Axes, t: NDArray[np.float64], phi: NDArray[np.float64], gait: Gait, fit: ClockFit | None
) -> Axes:
    """Every sample of phi, rad, at its phase of the period, over the command as a line."""
    known = np.flatnonzero(np.isfinite(phi))
    known = known[:: max(1, len(known) // _POINTS)]
    # One path of dashes as short as dots: a marker each makes a file several times as large.
    dash = gait.period * _DOT
    phase = t[known] % gait.period
    x = np.stack([phase - dash, phase + dash, np.full(len(known), np.nan)], 1).ravel()
    ax.plot(x, np.repeat(phi[known], 3), color=GREY, lw=2, solid_capstyle="round", label="seen")
    phase = np.linspace(0, gait.period, 400)
    ax.plot(phase, gait.angle(phase), color=FORWARD, lw=1.6, label="command")
    if fit is not None:
        text = f"offset {1e3 * fit.offset:+.2f} ± {1.96e3 * fit.sigma[0]:.2g} ms"
        note(ax, f"{text}, scale {fit.scale:.4f}", x=0.015, y=0.06, ha="left", va="bottom")
    ax.set_xlim(0, gait.period)
    ax.set_xlabel("phase of the command, s")
    ax.set_ylabel("φ, rad")
    ax.legend(loc="upper right", ncols=2)
    return ax


def difference(ax: Axes, t: NDArray[np.float64], phi: NDArray[np.float64], gait: Gait) -> Axes:
    """phi less its command, mrad, over time."""
    ax.plot(*thinned(t, 1e3 * (phi - gait.angle(t))), color=INK, lw=0.7)
    ax.axhline(0, color=FORWARD, lw=1.2)
    ax.set_xlim(t[0], t[-1])
    ax.set_xlabel("time, s")
    ax.set_ylabel("φ − command, mrad")
    return ax
