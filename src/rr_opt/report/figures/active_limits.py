"""Which limits and bounds hold the optimum where; and all figures of a study."""

from __future__ import annotations

from collections import Counter

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

from rr_opt.answers.study import StudyAnswer
from rr_opt.report.figures.study import (
    HATCHED,
    Grid,
    edges,
    grid_of,
    hatched,
    pareto,
    shown,
    speed,
    study_map,
)
from rr_opt.report.figures.style import FAINT, INK, figure, styled, svg

_COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#5b2a86")
_OTHERS = "#9aa5b1"


def words(held: tuple[str, ...]) -> str:
    """What holds an optimum, in words."""
    return " + ".join(name.replace("inertia_ratio", "J20/J10") for name in held) or "nothing"


def lanes(ax: Axes, result: StudyAnswer) -> Axes:
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


def areas(ax: Axes, result: StudyAnswer, grid: Grid) -> Axes:
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


_COSTS = (("peak_torque", "largest servo torque, N m"), ("energy_per_metre", "energy, J/m"))


def draw(result: StudyAnswer) -> dict[str, str]:
    """Draw all figures that the study has something to show in; none without an optimum."""
    if result.fastest is None:
        return {}
    with styled():
        drawn = {"speed": _speed(result), "held": _held(result), "pareto": _pareto(result)}
        if grid_of(result) is not None:
            drawn["map"] = _map(result)
    return drawn


def _speed(result: StudyAnswer) -> str:
    axes = [at for at, n in enumerate(result.study.shape) if n > 1] or [0]
    ordered = [at for at in axes if shown(result.study.axes[at]).ordered] or axes[:1]
    drawn = figure(6.3, 3.9 * len(ordered))
    for place, along in enumerate(ordered):
        speed(drawn.add_subplot(len(ordered), 1, place + 1), result, along)
    return svg(drawn)


def _map(result: StudyAnswer) -> str:
    grid = grid_of(result)
    drawn = figure(6.3, 4.6)
    if grid:
        study_map(drawn.add_subplot(), result, grid)
    return svg(drawn)


def _held(result: StudyAnswer) -> str:
    grid = grid_of(result)
    if grid is None:
        lanes_count = len({n for row in result.rows if row.optimum for n in row.optimum.held})
        drawn = figure(6.3, 1.1 + 0.42 * lanes_count)
        lanes(drawn.add_subplot(), result)
    else:
        drawn = figure(6.3, 5.6)
        areas(drawn.add_subplot(), result, grid)
    return svg(drawn)


def _pareto(result: StudyAnswer) -> str:
    drawn = figure(6.3, 6.6)
    for place, (name, label) in enumerate(_COSTS, 1):
        pareto(drawn.add_subplot(2, 1, place), result, name, label)
    return svg(drawn)
