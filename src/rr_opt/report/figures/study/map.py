"""Speed over two varied quantities."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.ticker import MaxNLocator

from rr_opt.report.figures.study.grid import Grid, hatched
from rr_opt.report.figures.style import INK, OPTIMUM, PAPER, SIGNED
from rr_opt.report.study.result import Studied

_LEAST_CELLS = 4
"""Along each axis, for lines of equal speed."""


def study_map(ax: Axes, result: Studied, grid: Grid) -> Axes:
    """A cell a case, the colour its signed speed; lines part branches; the star is the fastest.
    Hatched: no optimum."""
    speed = 1e3 * result.values("speed")[grid.cases]
    top = float(np.nanmax(np.abs(speed), initial=1e-9))
    hatched(ax)
    cells = ax.pcolormesh(*grid.borders, speed, cmap=SIGNED, norm=TwoSlopeNorm(0.0, -top, top),
                          zorder=1)  # fmt: skip
    cells.set_edgecolor("face")
    bar = ax.figure.colorbar(cells, ax=ax, pad=0.02, aspect=26, ticks=MaxNLocator(7))
    bar.set_label("mean speed, mm/s  (+ forward, − backward)")
    bar.outline.set_visible(False)  # type: ignore[operator]
    bar.ax.set_ylim(
        min(np.nanmin(speed, initial=0.0), 0.0), max(np.nanmax(speed, initial=0.0), 0.0)
    )
    _contours(ax, np.abs(speed), grid)
    _parting(ax, result, grid)
    row, column = np.unravel_index(np.nanargmax(np.abs(speed)), speed.shape)
    x, y = grid.centres
    ax.plot(x[column], y[row], "*", ms=17, mfc=OPTIMUM, mec=INK, mew=1.1, zorder=5)
    grid.frame(ax)
    return ax


def _contours(ax: Axes, speed: np.ndarray, grid: Grid) -> None:
    """Lines of equal speed, where there are cells enough, on scales, to draw them between."""
    if min(speed.shape) < _LEAST_CELLS or not (grid.x.ordered and grid.y.ordered):
        return
    lines = ax.contour(*grid.centres, speed, levels=7, colors=INK, linewidths=0.7, alpha=0.75,
                       zorder=3)  # fmt: skip
    for text in ax.clabel(lines, fontsize=8, fmt="%g"):
        text.set_bbox({"facecolor": PAPER, "edgecolor": "none", "alpha": 0.6, "pad": 0.8})


def _parting(ax: Axes, result: Studied, grid: Grid) -> None:
    """Lines between cells of different branches."""
    branch = np.array([one or 0 for one in result.branches])[grid.cases]
    x, y = grid.borders
    for row, column in np.argwhere(branch[:, 1:] != branch[:, :-1]):
        ax.plot([x[column + 1]] * 2, y[row : row + 2], color=INK, lw=2, zorder=4)
    for row, column in np.argwhere(branch[1:] != branch[:-1]):
        ax.plot(x[column : column + 2], [y[row + 1]] * 2, color=INK, lw=2, zorder=4)
