"""A study over two of its inputs: a map of the speed, and the active limits and bounds."""

from __future__ import annotations

from collections import Counter

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from rr_opt.report.figures import style
from rr_opt.report.figures.study_axes import Grid, scale_of
from rr_opt.results.inputs import held_words
from rr_opt.results.study import SolvedStudy

_LEAST_CELLS = 4
"""Along each axis, for lines of equal speed."""


def study_map(ax: Axes, result: SolvedStudy, grid: Grid) -> Axes:
    """A cell for each case, the colour its signed speed; lines part branches; the star is the
    fastest. Hatched: no optimum."""
    speed = 1e3 * result.values("speed")[grid.cases]
    top = float(np.nanmax(np.abs(speed), initial=1e-9))
    style.hatched(ax)
    cells = ax.pcolormesh(*grid.borders, speed, cmap=style.SIGNED, norm=style.signed(top), zorder=1)
    cells.set_edgecolor("face")
    ends = np.nanmin(speed, initial=0.0), np.nanmax(speed, initial=0.0)
    style.speed_bar(ax, cells).set_ylim(min(ends[0], 0.0), max(ends[1], 0.0))
    _contours(ax, np.abs(speed), grid)
    _parting(ax, result, grid)
    row, column = np.unravel_index(np.nanargmax(np.abs(speed)), speed.shape)
    x, y = grid.centres
    ax.plot(x[column], y[row], ms=17, mew=1.1, zorder=5, **style.STAR)
    grid.frame(ax)
    return ax


def _contours(ax: Axes, speed: np.ndarray, grid: Grid) -> None:
    """Lines of equal speed, where there are cells enough, on scales, to draw them between."""
    if min(speed.shape) < _LEAST_CELLS or not (grid.x.ordered and grid.y.ordered):
        return
    lines = ax.contour(*grid.centres, speed, levels=7, colors=style.INK, linewidths=0.7, alpha=0.75,
                       zorder=3)  # fmt: skip
    for text in ax.clabel(lines, fontsize=8, fmt="%g"):
        text.set_bbox({"facecolor": style.PAPER, "edgecolor": "none", "alpha": 0.6, "pad": 0.8})


def _parting(ax: Axes, result: SolvedStudy, grid: Grid) -> None:
    """Lines between cells of different branches."""
    branch = np.array([one or 0 for one in result.branches])[grid.cases]
    x, y = grid.borders
    for row, column in np.argwhere(branch[:, 1:] != branch[:, :-1]):
        ax.plot([x[column + 1]] * 2, y[row : row + 2], color=style.INK, lw=2, zorder=4)
    for row, column in np.argwhere(branch[1:] != branch[:-1]):
        ax.plot(x[column : column + 2], [y[row + 1]] * 2, color=style.INK, lw=2, zorder=4)


_COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#5b2a86")
_OTHERS = "#9aa5b1"


def active_lanes(ax: Axes, result: SolvedStudy) -> Axes:
    """A lane for each limit and bound, filled where it is active, over the only axis."""
    scale = scale_of(result.study.axes[0])
    rows = [result.rows[step].optimum for step in scale.order]
    names = [n for n, _ in Counter(n for one in rows if one for n in one.held).most_common()]
    borders = scale.edges
    for lane, name in enumerate(names):
        for at, one in enumerate(rows):
            on = one is not None and name in one.held
            ax.fill_between(borders[at : at + 2], lane - 0.38, lane + 0.38, lw=0,
                            color=_COLOURS[lane % len(_COLOURS)] if on else style.FAINT,
                            alpha=1.0 if on else 0.5)  # fmt: skip
    style.lanes(ax, [held_words((name,))[0] for name in names])
    ax.set_xlim(borders[0], borders[-1])
    ax.grid(visible=False)
    scale.apply(ax)
    return ax


def active_areas(ax: Axes, result: SolvedStudy, grid: Grid) -> Axes:
    """Each case in the colour of what limits it; the rarest share a grey. Hatched: no optimum."""
    sets = [
        None if one.optimum is None else " + ".join(held_words(one.optimum.held))
        for one in result.rows
    ]
    seen = Counter(sets[case] for case in grid.cases.ravel())
    seen.pop(None, None)
    named = [name for name, _ in seen.most_common(len(_COLOURS))]
    index = np.full(grid.cases.shape, np.nan)
    for at, case in np.ndenumerate(grid.cases):
        if sets[case] is not None:
            index[at] = named.index(sets[case]) if sets[case] in named else len(named)
    colours = [*_COLOURS[: len(named)], _OTHERS]
    style.hatched(ax)
    ax.pcolormesh(*grid.borders, index, cmap=ListedColormap(colours), vmin=-0.5,
                  vmax=len(named) + 0.5, edgecolors="white", linewidth=0.4, zorder=1)  # fmt: skip
    grid.frame(ax)
    handles = [
        Patch(color=colour, label=name) for colour, name in zip(colours, named, strict=False)
    ]
    if len(seen) > len(named):
        handles.append(Patch(color=_OTHERS, label="others"))
    if np.isnan(index).any():
        handles.append(Patch(**style.HATCHED, label="no optimum"))
    ax.figure.legend(handles=handles, loc="outside lower left", labelcolor=style.INK)  # type: ignore[union-attr]
    return ax
