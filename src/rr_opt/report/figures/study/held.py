"""Which limits and bounds hold the optimum where: lanes over one axis, areas over two."""

from __future__ import annotations

from collections import Counter

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from rr_opt.report.figures.study.axis import shown
from rr_opt.report.figures.study.grid import HATCHED, Grid, edges, hatched
from rr_opt.report.figures.style import FAINT, INK
from rr_opt.report.study.result import Studied

_COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#5b2a86")
_OTHERS = "#9aa5b1"


def words(held: tuple[str, ...]) -> str:
    """What holds an optimum, in words."""
    return " + ".join(name.replace("inertia_ratio", "J20/J10") for name in held) or "nothing"


def lanes(ax: Axes, result: Studied) -> Axes:
    """A lane for each limit and bound, filled where it holds the optimum, over the only axis."""
    axis = shown(result.study.axes[0])
    order = axis.order
    rows = [result.rows[step].optimum for step in order]
    names = [n for n, _ in Counter(n for one in rows if one for n in one.held).most_common()]
    borders = edges(axis.steps[order], log=axis.log)
    for lane, name in enumerate(names):
        for at, one in enumerate(rows):
            on = one is not None and name in one.held
            ax.fill_between(borders[at : at + 2], lane - 0.38, lane + 0.38, lw=0,
                            color=_COLOURS[lane % len(_COLOURS)] if on else FAINT,
                            alpha=1.0 if on else 0.5)  # fmt: skip
    ax.set_yticks(range(len(names)), [words((name,)) for name in names])
    ax.set_ylim(len(names) - 0.4, -0.6)
    ax.set_xlim(borders[0], borders[-1])
    ax.grid(visible=False)
    ax.spines["left"].set_visible(False)
    ax.tick_params(axis="y", length=0)
    axis.scale(ax)
    return ax


def areas(ax: Axes, result: Studied, grid: Grid) -> Axes:
    """Each case in the colour of what holds it; the rarest share a grey. Hatched: no
    optimum."""
    sets = [None if one.optimum is None else words(one.optimum.held) for one in result.rows]
    seen = Counter(sets[case] for case in grid.cases.ravel())
    seen.pop(None, None)
    named = [name for name, _ in seen.most_common(len(_COLOURS))]
    index = np.full(grid.cases.shape, np.nan)
    for at, case in np.ndenumerate(grid.cases):
        if sets[case] is not None:
            index[at] = named.index(sets[case]) if sets[case] in named else len(named)
    colours = [*_COLOURS[: len(named)], _OTHERS]
    hatched(ax)
    ax.pcolormesh(*grid.borders, index, cmap=ListedColormap(colours), vmin=-0.5,
                  vmax=len(named) + 0.5, edgecolors="white", linewidth=0.4, zorder=1)  # fmt: skip
    grid.frame(ax)
    handles = [
        Patch(color=colour, label=name) for colour, name in zip(colours, named, strict=False)
    ]
    if len(seen) > len(named):
        handles.append(Patch(color=_OTHERS, label="others"))
    if np.isnan(index).any():
        handles.append(Patch(**HATCHED, label="no optimum"))
    ax.figure.legend(handles=handles, loc="outside lower left", labelcolor=INK)  # type: ignore[union-attr]
    return ax
