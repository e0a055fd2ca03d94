"""Speed over one varied quantity, a line for each combination of the others."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize

from rr_opt.report.figures.study.axis import Shown, shown
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK, LIMIT
from rr_opt.report.study.result import Studied

FAMILY = LinearSegmentedColormap.from_list(
    "family", ["#5b2a86", "#0072b2", "#009e73", "#c9a400", "#d55e00"]
)
"""Five hues of one order, dark to warm, that colour-blind readers can tell apart."""
_MOST_NAMED = 7
_PRICED = 0.22
"""Half the length of a shadow price's tangent, in gaps between steps."""


def speed(ax: Axes, result: Studied, along: int) -> Axes:
    """|speed| over the axis `along`. A line is broken where the branch changes; triangles point
    up for forward, down for backward; a short tangent is the limit's shadow price."""
    axes = [shown(axis) for axis in result.study.axes]
    mine = axes[along]
    others = [at for at in range(len(axes)) if at != along]
    colours = _Colours(axes[others[0]] if others else None)
    worst = 0
    for fixed, cases in _lines(result, along, mine.order):
        x = mine.steps[mine.order]
        y = 1e3 * result.speed[cases]
        colour = colours.of(fixed[0]) if others else None
        _line(ax, x, y, [result.branches[case] for case in cases], colour or GREY)
        for at, case in enumerate(cases):
            optimum = result.rows[case].optimum
            if optimum is None:
                worst += 1
                continue
            forward = optimum.speed > 0
            way = FORWARD if forward else BACKWARD
            ax.plot(x[at], y[at], "^" if forward else "v", ms=6, color=colour or way, mec="white",
                    mew=0.6, zorder=4)  # fmt: skip
        if not others and mine.ordered:
            _tangents(ax, result, cases, mine)
    if worst:
        words = (
            "1 case without an optimum is"
            if worst == 1
            else f"{worst} cases without an optimum are"
        )
        # Above the axes: within them it would lie over curves.
        ax.set_title(f"{words} left out", loc="right", fontsize=9.0, fontweight="normal",
                     color=GREY)  # fmt: skip
    mine.scale(ax)
    ax.set_ylim(0, 1.06e3 * np.nanmax(result.speed))
    ax.set_ylabel("speed, mm/s")
    colours.explain(ax)
    return ax


def _lines(
    result: Studied, along: int, order: list[int]
) -> Iterator[tuple[tuple[int, ...], list[int]]]:
    """For each combination of the other axes: its steps there, and its cases in order."""
    grid = np.arange(len(result.rows)).reshape(result.study.shape)
    moved = np.moveaxis(grid, along, -1)
    for fixed in itertools.product(*map(range, moved.shape[:-1])):
        yield fixed, [int(case) for case in moved[fixed][order]]


def _line(ax: Axes, x: np.ndarray, y: np.ndarray, branch: list[int | None], colour: str) -> None:
    for at in range(len(x) - 1):
        joined = branch[at] == branch[at + 1]
        style = {"ls": "-", "lw": 1.6} if joined else {"ls": ":", "lw": 1.0}
        ax.plot(x[at : at + 2], y[at : at + 2], color=colour, zorder=3, **style)  # type: ignore[arg-type]


def _tangents(ax: Axes, result: Studied, cases: list[int], mine: Shown) -> None:
    """What the shadow price of the varied limit foretells, at each case."""
    (axis,) = result.study.axes
    name = axis.lines[0].key.name.removeprefix("limits.")
    x = mine.steps[mine.order]
    half = _PRICED * np.diff(x).mean() if len(x) > 1 else 0.0
    drawn = False
    for at, case in enumerate(cases):
        optimum = result.rows[case].optimum
        price = optimum.prices.get(name) if optimum else None
        if optimum is None or price is None:
            continue
        slope, y = 1e3 * price / mine.factor, 1e3 * abs(optimum.speed)
        ax.plot([x[at] - half, x[at] + half], [y - slope * half, y + slope * half], color=LIMIT,
                lw=2.6, solid_capstyle="round", zorder=3.5,
                label=None if drawn else "shadow price")  # fmt: skip
        drawn = True
    if drawn:
        ax.legend(loc="best")


class _Colours:
    """A colour for each step of the first of the other axes, and what tells them."""

    def __init__(self, axis: Shown | None):
        self._axis = axis
        self._norm = None
        if axis is not None and axis.ordered:
            kind = LogNorm if axis.log else Normalize
            self._norm = kind(float(axis.steps.min()), float(axis.steps.max()))

    def of(self, step: int) -> str:
        if self._axis is None:
            return INK
        if self._norm is not None:
            return FAMILY(float(self._norm(self._axis.steps[step])))  # type: ignore[return-value]
        return FAMILY((self._axis.steps[step] - 1) / max(len(self._axis.steps) - 1, 1))  # type: ignore[return-value]

    def explain(self, ax: Axes) -> None:
        axis = self._axis
        if axis is None:
            return
        steps = axis.order[::-1]
        if len(steps) > _MOST_NAMED:
            chosen = np.unique(np.linspace(0, len(steps) - 1, _MOST_NAMED).round().astype(int))
            steps = [steps[at] for at in chosen]
        for step in steps:
            ax.plot([], [], color=self.of(step), label=axis.texts[step])
        title = axis.label.split(",")[0]
        ax.legend(title=title, loc="center left", bbox_to_anchor=(1.0, 0.5), alignment="left")
