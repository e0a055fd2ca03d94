"""A recorded path, and what the model as believed and the model as found make of it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rr_opt.diagnose.diagnosis import Misfit
from rr_opt.experiment.recording import Recording
from rr_opt.report.figures.diagnosis.look import FINAL, NOMINAL, RECORDED
from rr_opt.report.figures.style import INK, OPTIMUM
from rr_opt.report.quantities import number

_POINTS = 1500
_FLAT = 0.6


def path(ax: Axes, recording: Recording, nominal: Misfit, final: Misfit) -> Axes:
    """The tracked point, m; how far off each simulation is, RMS, mm."""
    seen = np.column_stack([recording.data("x"), recording.data("y")])
    step = max(1, len(seen) // _POINTS)
    ax.plot(*seen[::step].T, color=RECORDED, lw=5, solid_capstyle="round", label="recorded")
    for one, colour, style, words in (
        (nominal, NOMINAL, "--", "as believed"),
        (final, FINAL, "-", "as found"),
    ):
        ax.plot(*one.predicted[::step, :2].T, style, color=colour, lw=1.4, label=words)
    known = np.flatnonzero(np.isfinite(seen).all(axis=1))
    if len(known):
        ax.plot(*seen[known[0]], "o", ms=6, color=OPTIMUM, mec=INK, zorder=4)
    off = [number(1e3 * _distance(seen, one), 2) for one in (nominal, final)]
    held = ", held out" if final.held_out else ""
    ax.set_title(f"{final.recording}{held}\n{off[0]} mm off → {off[1]} mm", fontsize=9.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set_ylabel("y, m")
    ax.tick_params(labelsize=8.5)
    ax.locator_params(nbins=5)
    return ax


def flat(recording: Recording) -> bool:
    """Whether a path is much wider than high."""
    width, height = (np.ptp(y[np.isfinite(y)]) for y in map(recording.data, ("x", "y")))
    return bool(height < _FLAT * width)


def _distance(seen: NDArray[np.float64], one: Misfit) -> float:
    """RMS distance between the recorded and the simulated path, m; the noise is part of it."""
    square = np.sum((one.predicted[:, :2] - seen) ** 2, axis=1)
    return float(np.sqrt(np.nanmean(square))) if np.isfinite(square).any() else float("nan")
