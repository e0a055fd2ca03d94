"""Speed over what a study varies: lines, maps, and what speed costs."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize, TwoSlopeNorm
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator
from numpy.typing import NDArray

from rr_opt.answers.quantities import number
from rr_opt.answers.study import StudyAnswer, front, unit_of, value_text
from rr_opt.array import Array
from rr_opt.files.study_axes import Axis
from rr_opt.report.figures.style import BACKWARD, FORWARD, GREY, INK, LIMIT, OPTIMUM, PAPER, SIGNED

_EVEN = 0.05
_WIDEST = 60
"""Letters of names that fit side by side under a figure."""


@dataclass(frozen=True)
class Shown:
    """steps in the unit that people think in, and how they are called; factor: how many of that
    unit are one SI unit; log: on a logarithmic scale.

    ordered: steps are numbers with a place on a scale. If one is none, or is infinite, they are
    named and stand one beside the other, at 1, 2, 3 ..: the finite ones by size, infinity last.
    """

    label: str
    unit: str
    steps: Array
    texts: tuple[str, ...]
    factor: float
    ordered: bool
    log: bool

    @property
    def order(self) -> list[int]:
        """The steps from the smallest to the largest."""
        return [int(step) for step in np.argsort(self.steps, kind="stable")]

    def scale(self, ax: Axes, which: str = "x") -> None:
        """Label the axis of a figure and set its scale."""
        getattr(ax, f"set_{which}label")(self.label)
        if self.log:
            getattr(ax, f"set_{which}scale")("log")
            _plain_ticks(ax, which, self.steps)
        if not self.ordered:
            slant = which == "x" and sum(map(len, self.texts)) > _WIDEST
            style = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if slant else {}
            getattr(ax, f"set_{which}ticks")(self.steps, self.texts, **style)


def shown(axis: Axis) -> Shown:
    """How to show an axis; keys that are taken in step are shown by the first."""
    line = next((line for line in axis.lines if line.numbers is not None), axis.lines[0])
    unit, factor = unit_of(line.key)
    more = f" and {len(axis.lines) - 1} more" if len(axis.lines) > 1 else ""
    numbers = line.numbers
    if numbers is None or not np.isfinite(numbers).all():
        values = line.values if numbers is None else numbers
        texts = tuple(value_text(line.key, value, 3) for value in values)
        rank = np.arange(len(texts)) if numbers is None else np.argsort(np.argsort(numbers))
        places = np.asarray(1 + rank, float)
        return Shown(f"{line.key.name}{more}", "", places, texts, 1.0, False, False)
    steps = factor * np.array(numbers)
    texts = tuple(value_text(line.key, value, 3) for value in numbers)
    label = f"{line.key.name}{more}" + (f", {unit}" if unit else "")
    return Shown(label, unit, steps, texts, factor, True, _even_in_log(steps))


def _even_in_log(steps: Array) -> bool:
    ordered = np.sort(steps)
    if len(ordered) < 3 or ordered[0] <= 0 or ordered[-1] < 2 * ordered[0]:
        return False
    ratios, gaps = np.diff(np.log(ordered)), np.diff(ordered)
    return bool(np.ptp(ratios) < _EVEN * ratios.mean() and np.ptp(gaps) > _EVEN * gaps.mean())


def _plain_ticks(ax: Axes, which: str, steps: Array) -> None:
    """Ticks at the steps themselves, at most six of them: powers of ten alone are too few."""
    ordered = np.sort(steps)
    chosen = ordered[np.unique(np.linspace(0, len(ordered) - 1, 6).round().astype(int))]
    getattr(ax, f"set_{which}ticks")(chosen, [number(step, 2) for step in chosen])
    getattr(ax, f"set_{which}ticks")([], minor=True)


_GROUND = "#eceff2"
HATCHED: dict[str, Any] = {"facecolor": _GROUND, "edgecolor": "#b4bdc6", "hatch": "////", "lw": 0}
"""How what has no optimum looks."""


@dataclass(frozen=True)
class Grid:
    """cases (Y, X): of those that share a place, that with the fastest optimum."""

    x: Shown
    y: Shown
    cases: NDArray[np.int_]
    hidden: int

    @property
    def borders(self) -> tuple[Array, Array]:
        """Where the cells of the map begin and end along x and y."""
        return tuple(edges(axis.steps[axis.order], log=axis.log) for axis in (self.x, self.y))  # type: ignore[return-value]

    @property
    def centres(self) -> tuple[Array, Array]:
        """The steps along x and y."""
        return self.x.steps[self.x.order], self.y.steps[self.y.order]

    def frame(self, ax: Axes) -> None:
        """Labels, scales and limits."""
        self.x.scale(ax, "x")
        self.y.scale(ax, "y")
        (left, right), (low, high) = ((part[0], part[-1]) for part in self.borders)
        ax.set_xlim(left, right)
        ax.set_ylim(low, high)
        ax.grid(visible=False)


def grid_of(result: StudyAnswer) -> Grid | None:
    """The map over the two longest axes; None if the study has only one."""
    shape = result.study.shape
    if len(shape) < 2:
        return None
    first, second = sorted(np.argsort([-n for n in shape], kind="stable")[:2])
    x, y = (shown(result.study.axes[at]) for at in (first, second))
    cases = np.arange(len(result.rows)).reshape(shape)
    cases = np.moveaxis(cases, (second, first), (0, 1)).reshape(shape[second], shape[first], -1)
    speed = np.nan_to_num(result.speed, nan=-1.0)
    best = np.take_along_axis(cases, speed[cases].argmax(axis=2)[:, :, None], axis=2)[:, :, 0]
    return Grid(x, y, best[np.ix_(y.order, x.order)], cases.shape[2] - 1)


def hatched(ax: Axes) -> None:
    """Hatch the ground of a map, to be seen where no cell is drawn: there is no optimum."""
    ax.set_facecolor(_GROUND)
    ax.fill_between([0, 1], 0, 1, transform=ax.transAxes, zorder=0, **HATCHED)


def edges(steps: Array, *, log: bool = False) -> Array:
    """Borders halfway between steps, and as far beyond the first and the last."""
    if len(steps) == 1:
        return steps[0] + np.array([-0.5, 0.5])
    placed = np.log(steps) if log else steps
    middle = (placed[:-1] + placed[1:]) / 2
    ends = [2 * placed[0] - middle[0], *middle, 2 * placed[-1] - middle[-1]]
    return np.exp(ends) if log else np.array(ends)


_LEAST_CELLS = 4
"""Along each axis, for lines of equal speed."""


def study_map(ax: Axes, result: StudyAnswer, grid: Grid) -> Axes:
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


def _parting(ax: Axes, result: StudyAnswer, grid: Grid) -> None:
    """Lines between cells of different branches."""
    branch = np.array([one or 0 for one in result.branches])[grid.cases]
    x, y = grid.borders
    for row, column in np.argwhere(branch[:, 1:] != branch[:, :-1]):
        ax.plot([x[column + 1]] * 2, y[row : row + 2], color=INK, lw=2, zorder=4)
    for row, column in np.argwhere(branch[1:] != branch[:-1]):
        ax.plot(x[column : column + 2], [y[row + 1]] * 2, color=INK, lw=2, zorder=4)


def pareto(ax: Axes, result: StudyAnswer, name: str, label: str) -> Axes:
    """A dot a case, blue forward and orange backward; ringed, on the line: no other case is both
    faster and cheaper. name: the number of the optimum that is the cost."""
    cost, speed = result.values(name), 1e3 * result.speed
    forward = result.values("speed") > 0
    for way, colour, word in ((forward, FORWARD, "forward"), (~forward, BACKWARD, "backward")):
        some = way & np.isfinite(speed)
        if some.any():
            ax.plot(cost[some], speed[some], "o", ms=5, mec="none", color=colour, alpha=0.45,
                    label=word)  # fmt: skip
    best = front(cost, speed)
    ax.plot(cost[best], speed[best], drawstyle="steps-post", color=INK, lw=1.2, zorder=3)
    ax.plot(cost[best], speed[best], "o", ms=7, mfc=OPTIMUM, mec=INK, mew=1.0, zorder=4,
            label="front")  # fmt: skip
    if np.nanmax(cost) > 20 * np.nanmin(cost) > 0:
        ax.set_xscale("log")
        ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_locator(NullLocator())
    ax.set_ylim(0, 1.06 * np.nanmax(speed))
    ax.set_xlabel(label)
    ax.set_ylabel("speed, mm/s")
    ax.legend(loc="best")
    return ax


FAMILY = LinearSegmentedColormap.from_list(
    "family", ["#5b2a86", "#0072b2", "#009e73", "#c9a400", "#d55e00"]
)
"""Five hues of one order, dark to warm, that colour-blind readers can tell apart."""
_MOST_NAMED = 7
_PRICED = 0.22
"""Half the length of a shadow price's tangent, in gaps between steps."""


def speed(ax: Axes, result: StudyAnswer, along: int) -> Axes:
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
    result: StudyAnswer, along: int, order: list[int]
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


def _tangents(ax: Axes, result: StudyAnswer, cases: list[int], mine: Shown) -> None:
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
