"""The channels over time, with gaps and flags marked."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from rr_opt.experiment.recording import Flag, Recording
from rr_opt.recordings.gaps import Gap, bridged
from rr_opt.report.figures.inspect.thinned import thinned
from rr_opt.report.figures.style import BACKWARD, INK, LIMIT, PLATFORM2

_LABELS = {"x": "x, m", "y": "y, m", "psi": "ψ, rad", "phi": "φ, rad", "torque": "τ, N m"}
_MARKS = ((Flag.OUTLIER, "outlier", "x", BACKWARD), (Flag.OUT_OF_ORDER, "out of order", "+", LIMIT))
_MOST_GAPS = 200


def channels(axes: Sequence[Axes], recording: Recording, holes: Sequence[Gap]) -> None:
    """One axes a channel; a shaded band is a gap, a cross a flagged sample.

    Short gaps are bridged by thin lines, in the drawing only.
    """
    t = recording.t
    for ax, channel in zip(axes, recording.channels, strict=True):
        y = recording.data(channel)
        if not np.isfinite(y).all():
            ax.plot(*thinned(t, bridged(t, y)), color=PLATFORM2, lw=0.8)
        ax.plot(*thinned(t, y), color=INK, lw=1.1)
        _bands(ax, channel, holes)
        _flags(ax, recording, channel)
        ax.set_ylabel(_LABELS.get(channel, channel))
        ax.set_xlim(t[0], t[-1])
        _limits(ax, y)
    axes[-1].set_xlabel("time, s")


def _bands(ax: Axes, channel: str, holes: Sequence[Gap]) -> None:
    mine = [gap for gap in holes if channel in gap.channels or not gap.channels]
    for gap in sorted(mine, key=lambda one: -one.length)[:_MOST_GAPS]:
        ax.axvspan(gap.start, gap.end, color=PLATFORM2, alpha=0.25, lw=0)


def _flags(ax: Axes, recording: Recording, channel: str) -> None:
    shown = False
    for flag, words, mark, colour in _MARKS:
        rows = np.flatnonzero(recording.flags[channel] & flag)[:2000]
        if len(rows):
            ax.plot(recording.t[rows], recording.values[channel][rows], mark, color=colour, ms=5,
                    mew=1.2, label=words)  # fmt: skip
            shown = True
    if shown:
        ax.legend(loc="upper right", ncols=2)


def _limits(ax: Axes, y: np.ndarray) -> None:
    """The data fill the axes; an outlier far away is cut off, not they flattened."""
    known = y[np.isfinite(y)]
    if len(known) and np.ptp(known) > 0:
        room = 0.15 * float(np.ptp(known))
        ax.set_ylim(float(known.min()) - room, float(known.max()) + room)
