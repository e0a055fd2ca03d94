"""Each model's best fit beside the nine rows, for both readings of the columns."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.measured import COLUMNS, ROWS, T_POINT, Column, measured
from rr_opt.report.figures.style import (
    BACKWARD,
    FAINT,
    FORWARD,
    GREY,
    INK,
    LIMIT,
    PLATFORM1,
    figure,
)

_MARKS = {
    "viscous": ("o", FORWARD),
    "viscous+dry": ("D", PLATFORM1),
    "rate limit": ("v", BACKWARD),
    "lag": ("P", GREY),
    "printed": ("x", LIMIT),
}
_EDGE = 2.4
"""Half widths beyond which a mark stands at the edge, as an arrow."""

TITLES: dict[Column, str] = {
    "mean": "If the first column was measured",
    "other": "If the column headed v_exp was measured",
}


def predictions(found: Calibration) -> Figure:
    """A panel for each column; a mark for each model and row, in half widths of the interval."""
    drawn = figure(10.2, 6.4)
    axes = drawn.subplots(2, 1, sharex=True)
    for ax, column in zip(axes, COLUMNS, strict=True):
        _panel(ax, found, column)
    labels = [
        f"ratio {row.ratio:g}\nα = ?" if row.amplitude is None
        else f"T = {row.period:g} s\nα = {row.amplitude:g}"
        for row in ROWS
    ]  # fmt: skip
    axes[-1].set_xticks(range(len(ROWS)), labels)
    handles, names = axes[0].get_legend_handles_labels()
    drawn.legend(handles, names, loc="outside lower center", ncols=6)
    drawn.supylabel("(predicted − measured) / half width", fontsize=10.5)
    return drawn


def _panel(ax: Axes, found: Calibration, column: Column) -> None:
    data = measured(column)
    ax.axhspan(-1, 1, color=FAINT, lw=0)
    ax.axhline(0, color=GREY, lw=0.8)
    ax.axvline(2.5, color=GREY, lw=0.8, ls=":")
    for i, (name, (mark, colour)) in enumerate(_MARKS.items()):
        off = found.held[name, column].student.z(data) / T_POINT
        place = np.arange(len(off)) + 0.12 * (i - (len(_MARKS) - 1) / 2)
        inside = np.abs(off) <= _EDGE
        style = {"color": colour, "ls": "", "ms": 6.5}
        ax.plot(place[inside], off[inside], mark, label=name, **style)  # type: ignore[arg-type]
        for x, y in zip(place[~inside], off[~inside], strict=True):
            ax.plot(x, np.copysign(_EDGE, y), "^" if y > 0 else "v", color=colour, ms=6.5)
            ax.annotate(f"{y:+.0f}", (x, np.copysign(_EDGE, y)), fontsize=7.5, color=INK,
                        ha="center", va="bottom" if y > 0 else "top",
                        xytext=(0, 4 if y > 0 else -4), textcoords="offset points")  # fmt: skip
    ax.set_ylim(-1.2 * _EDGE, 1.2 * _EDGE)
    ax.grid(axis="x", visible=False)
    ax.set_title(f"{TITLES[column]}: inside the grey band is inside the 95 % interval")
