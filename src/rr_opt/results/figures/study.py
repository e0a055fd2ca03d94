"""The figures of a study: its varied keys as axes, maps of the speed and of the active limits."""

from collections import Counter
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, ListedColormap, LogNorm, Normalize
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.files.study_axes import Axis
from rr_opt.formatting import counted, number
from rr_opt.results.figures import style
from rr_opt.results.study import SolvedStudy
from rr_opt.results.study_table import axis_words, held_words, unit_of, value_text

_EVEN = 0.05
_WIDEST = 60
"""Most letters of names that fit side by side under a figure."""


@dataclass(frozen=True)
class Scale:
    """The steps of an axis in the customary unit, and their names.

    factor   how many of that unit are one SI unit
    ordered  steps are numbers on a scale, logarithmic if `log`. If one is not a number, or is
             infinite, they are named and equally spaced at 1, 2, 3 ..: the finite ones by
             size, infinity last
    """

    label: str
    steps: Array
    texts: tuple[str, ...]
    factor: float
    ordered: bool
    log: bool

    @property
    def order(self) -> list[int]:
        """The steps from the smallest to the largest."""
        return [int(step) for step in np.argsort(self.steps, kind="stable")]

    @property
    def edges(self) -> Array:
        """Borders halfway between the ordered steps, and as far beyond the first and the last."""
        steps = self.steps[self.order]
        if len(steps) == 1:
            return steps[0] + np.array([-0.5, 0.5])
        placed = np.log(steps) if self.log else steps
        middle = (placed[:-1] + placed[1:]) / 2
        ends = [2 * placed[0] - middle[0], *middle, 2 * placed[-1] - middle[-1]]
        return np.exp(ends) if self.log else np.array(ends)

    def apply(self, ax: Axes, which: str = "x") -> None:
        """Label the axis of a figure and set its scale."""
        getattr(ax, f"set_{which}label")(self.label)
        ticks = getattr(ax, f"set_{which}ticks")
        if self.log:
            getattr(ax, f"set_{which}scale")("log")
            # At most six steps: ticks at powers of ten alone are too few.
            ordered = np.sort(self.steps)
            chosen = ordered[np.unique(np.linspace(0, len(ordered) - 1, 6).round().astype(int))]
            ticks(chosen, [number(step, 2) for step in chosen])
            ticks([], minor=True)
        if not self.ordered:
            slant = which == "x" and sum(map(len, self.texts)) > _WIDEST
            style = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if slant else {}
            ticks(self.steps, self.texts, **style)


def scale_of(axis: Axis) -> Scale:
    """How to show an axis; keys that are varied together are represented by the first."""
    line = next((line for line in axis.lines if line.numbers is not None), axis.lines[0])
    unit, factor = unit_of(line.key)
    name, numbers = axis_words(axis), line.numbers
    values = line.values if numbers is None else numbers
    texts = tuple(value_text(line.key, value, 3) for value in values)
    if numbers is None or not np.isfinite(numbers).all():
        rank = np.arange(len(texts)) if numbers is None else np.argsort(np.argsort(numbers))
        return Scale(name, np.asarray(1 + rank, float), texts, 1.0, False, False)
    steps = factor * np.array(numbers)
    label = f"{name}, {unit}" if unit else name
    return Scale(label, steps, texts, factor, True, _even_in_log(steps))


def _even_in_log(steps: Array) -> bool:
    ordered = np.sort(steps)
    if len(ordered) < 3 or ordered[0] <= 0 or ordered[-1] < 2 * ordered[0]:
        return False
    ratios, gaps = np.diff(np.log(ordered)), np.diff(ordered)
    return bool(np.ptp(ratios) < _EVEN * ratios.mean() and np.ptp(gaps) > _EVEN * gaps.mean())


@dataclass(frozen=True)
class StudyGrid:
    """cases (Y, X): where several coincide, the one with the fastest optimum."""

    x: Scale
    y: Scale
    cases: NDArray[np.int_]

    @property
    def borders(self) -> tuple[Array, Array]:
        """Where the cells of the map begin and end along x and y."""
        return self.x.edges, self.y.edges

    @property
    def centres(self) -> tuple[Array, Array]:
        """The steps along x and y."""
        return self.x.steps[self.x.order], self.y.steps[self.y.order]

    def frame(self, ax: Axes) -> None:
        """Labels, scales and limits."""
        self.x.apply(ax, "x")
        self.y.apply(ax, "y")
        (left, right), (low, high) = ((part[0], part[-1]) for part in self.borders)
        ax.set(xlim=(left, right), ylim=(low, high))
        ax.grid(visible=False)


def grid_of(result: SolvedStudy) -> StudyGrid | None:
    """The map over the two longest axes; None if the study has only one."""
    shape = result.study.shape
    if len(shape) < 2:
        return None
    first, second = sorted(np.argsort([-n for n in shape], kind="stable")[:2])
    x, y = (scale_of(result.study.axes[at]) for at in (first, second))
    cases = np.arange(len(result.rows)).reshape(shape)
    cases = np.moveaxis(cases, (second, first), (0, 1)).reshape(shape[second], shape[first], -1)
    speed = np.nan_to_num(result.speed, nan=-1.0)
    best = np.take_along_axis(cases, speed[cases].argmax(axis=2)[:, :, None], axis=2)[:, :, 0]
    return StudyGrid(x, y, best[np.ix_(y.order, x.order)])


_LEAST_CELLS = 4
"""Fewest cells along each axis for contour lines."""


def study_map(ax: Axes, result: SolvedStudy, grid: StudyGrid) -> None:
    """A cell for each case, coloured by signed speed; lines separate branches; the star is the
    fastest. Hatched: no optimum."""
    speed = 1e3 * result.values("speed")[grid.cases]
    top = float(np.nanmax(np.abs(speed), initial=1e-9))
    style.hatched(ax)
    cells = ax.pcolormesh(*grid.borders, speed, cmap=style.SIGNED, norm=style.signed(top), zorder=1)
    cells.set_edgecolor("face")
    ends = np.nanmin(speed, initial=0.0), np.nanmax(speed, initial=0.0)
    style.speed_bar(ax, cells).set_ylim(min(ends[0], 0.0), max(ends[1], 0.0))
    style.cells(ax, *grid.centres, speed, "mean speed, mm/s")
    _contours(ax, np.abs(speed), grid)
    _parting(ax, result, grid)
    row, column = np.unravel_index(np.nanargmax(np.abs(speed)), speed.shape)
    x, y = grid.centres
    ax.plot(x[column], y[row], ms=17, mew=1.1, zorder=5, **style.STAR)
    grid.frame(ax)


def _contours(ax: Axes, speed: np.ndarray, grid: StudyGrid) -> None:
    """Contour lines of the speed, if there are enough ordered cells."""
    if min(speed.shape) < _LEAST_CELLS or not (grid.x.ordered and grid.y.ordered):
        return
    lines = ax.contour(*grid.centres, speed, levels=7, colors=style.INK, linewidths=0.7, alpha=0.75,
                       zorder=3)  # fmt: skip
    for text in ax.clabel(lines, fontsize=8, fmt="%g"):
        text.set_bbox({"facecolor": style.PAPER, "edgecolor": "none", "alpha": 0.6, "pad": 0.8})


def _parting(ax: Axes, result: SolvedStudy, grid: StudyGrid) -> None:
    """Lines between cells of different branches."""
    branch = np.array([one or 0 for one in result.branches])[grid.cases]
    x, y = grid.borders
    for row, column in np.argwhere(branch[:, 1:] != branch[:, :-1]):
        ax.plot([x[column + 1]] * 2, y[row : row + 2], color=style.INK, lw=2, zorder=4)
    for row, column in np.argwhere(branch[1:] != branch[:-1]):
        ax.plot(x[column : column + 2], [y[row + 1]] * 2, color=style.INK, lw=2, zorder=4)


_COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#5b2a86")
_OTHERS = "#9aa5b1"


def active_lanes(ax: Axes, result: SolvedStudy) -> None:
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


def active_areas(ax: Axes, result: SolvedStudy, grid: StudyGrid) -> None:
    """Each case coloured by its active limits; the rarest share a grey. Hatched: no optimum."""
    sets = [
        None if one.optimum is None else " + ".join(held_words(one.optimum.held))
        for one in result.rows
    ]
    seen = Counter(sets[case] for case in grid.cases.ravel())
    seen.pop(None, None)
    named = [name for name, _ in seen.most_common(len(_COLOURS))]
    place = {None: np.nan, **{name: at for at, name in enumerate(named)}}
    index = np.array([place.get(one, len(named)) for one in sets], float)[grid.cases]
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


_COSTS = (("peak_torque", "largest servo torque, N m"), ("cost_of_transport", "cost of transport"))


def draw(result: SolvedStudy) -> dict[str, str]:
    """All figures with content; none without an optimum."""
    if result.fastest is None:
        return {}
    axes = [at for at, n in enumerate(result.study.shape) if n > 1] or [0]
    ordered = [at for at in axes if scale_of(result.study.axes[at]).ordered] or axes[:1]
    speeds = style.figure(style.WIDTH, 4.3 * len(ordered))
    for ax, along in zip(np.ravel(speeds.subplots(len(ordered), 1)), ordered, strict=True):
        speed(ax, result, along)
    costs = style.figure(style.WIDTH, 6.2)
    for ax, (name, label) in zip(costs.subplots(2, 1), _COSTS, strict=True):
        pareto(ax, result, name, label)
    drawn = {"speed": style.svg(speeds), "pareto": style.svg(costs)}
    grid = grid_of(result)
    if grid is None:
        count = len({name for row in result.rows if row.optimum for name in row.optimum.held})
        return drawn | {
            "held": style.panel(1.1 + 0.42 * count, partial(active_lanes, result=result))
        }
    return drawn | {
        "held": style.panel(5.2, partial(active_areas, result=result, grid=grid)),
        "map": style.panel(4.2, partial(study_map, result=result, grid=grid)),
    }


def pareto(ax: Axes, result: SolvedStudy, name: str, label: str) -> None:
    """A dot for each case, blue forward and orange backward; ringed, on the line: the Pareto front
    of speed and cost. name: the number of the optimum that is the cost."""
    cost, speed = result.values(name), 1e3 * result.speed
    forward = result.values("speed") > 0
    for way, colour, word in (
        (forward, style.FORWARD, "forward"),
        (~forward, style.BACKWARD, "backward"),
    ):
        some = way & np.isfinite(speed)
        if some.any():
            ax.plot(cost[some], speed[some], "o", ms=5, mec="none", color=colour, alpha=0.45,
                    label=word)  # fmt: skip
    best = result.front(name)
    ax.plot(cost[best], speed[best], drawstyle="steps-post", color=style.INK, lw=1.2, zorder=3)
    ax.plot(cost[best], speed[best], "o", ms=7, mfc=style.OPTIMUM, mec=style.INK, mew=1.0, zorder=4,
            label="front")  # fmt: skip
    if np.nanmax(cost) > 20 * np.nanmin(cost) > 0:
        ax.set_xscale("log")
        ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_locator(NullLocator())
    ax.set(ylim=(0, 1.06 * np.nanmax(speed)), xlabel=label, ylabel="speed, mm/s")
    ax.legend(loc="best")


FAMILY = LinearSegmentedColormap.from_list(
    "family", ["#5b2a86", "#0072b2", "#009e73", "#c9a400", "#d55e00"]
)
"""Five hues in order, dark to warm, that colour-blind readers can distinguish."""
_MOST_NAMED = 7
_PRICED = 0.22
"""Half the length of a shadow price's tangent, relative to the spacing of steps."""


def speed(ax: Axes, result: SolvedStudy, along: int) -> None:
    """|speed| over the axis `along`. A line is broken where the branch changes; triangles point up
    for forward, down for backward; a short tangent is the limit's shadow price."""
    axes = [scale_of(axis) for axis in result.study.axes]
    mine, others = axes[along], [scale for at, scale in enumerate(axes) if at != along]
    x, left_out = mine.steps[mine.order], 0
    # A line for each combination of steps of the other axes.
    grid = np.moveaxis(np.arange(len(result.rows)).reshape(result.study.shape), along, -1)
    lines = [(fixed, grid[fixed][mine.order].tolist()) for fixed in np.ndindex(grid.shape[:-1])]
    # The first are the widest, so that coincident lines are all visible.
    widths = np.linspace(1.6 + 0.7 * min(len(lines) - 1, 5), 1.6, len(lines))
    for (fixed, cases), width in zip(lines, widths, strict=True):
        y = 1e3 * result.speed[cases]
        colour = _colour(others[0], fixed[0]) if others else None
        _broken(ax, x, y, [result.branches[case] for case in cases],
                colour or style.GREY, width)  # fmt: skip
        for at, case in enumerate(cases):
            optimum = result.rows[case].optimum
            if optimum is None:
                left_out += 1
                continue
            mark = "^" if optimum.speed > 0 else "v"
            ax.plot(x[at], y[at], mark, ms=6, color=colour or style.colour_of(optimum.speed),
                    mec="white", mew=0.6, zorder=4)  # fmt: skip
        if not others and mine.ordered:
            _tangents(ax, result, cases, mine)
    if left_out:
        words = f"{counted(left_out, 'case')} without an optimum {'is' if left_out == 1 else 'are'}"
        # Above the axes: inside, it would cover curves.
        ax.set_title(f"{words} left out", loc="right", fontsize=9.0, fontweight="normal",
                     color=style.GREY)  # fmt: skip
    mine.apply(ax)
    ax.set(ylim=(0, 1.06e3 * np.nanmax(result.speed)), ylabel="speed, mm/s")
    if others:
        _explain(ax, others[0])


def _broken(
    ax: Axes, x: np.ndarray, y: np.ndarray, branch: list[int | None], colour: str, width: float
) -> None:
    """A line through the points, dotted between branches."""
    for at in range(len(x) - 1):
        joined = branch[at] == branch[at + 1]
        ax.plot(x[at : at + 2], y[at : at + 2], color=colour, zorder=3, ls="-" if joined else ":",
                lw=width if joined else 1.0)  # fmt: skip


def _tangents(ax: Axes, result: SolvedStudy, cases: list[int], mine: Scale) -> None:
    """What the shadow price of the varied limit predicts, at each case."""
    (axis,) = result.study.axes
    name = axis.lines[0].key.name.removeprefix("limits.")
    x = mine.steps[mine.order]
    half = _PRICED * np.diff(x).mean() if len(x) > 1 else 0.0
    label: str | None = "shadow price"
    for at, case in enumerate(cases):
        optimum = result.rows[case].optimum
        price = optimum.prices.get(name) if optimum else None
        if optimum is None or price is None:
            continue
        slope, y = 1e3 * price / mine.factor, 1e3 * abs(optimum.speed)
        ax.plot([x[at] - half, x[at] + half], [y - slope * half, y + slope * half],
                color=style.LIMIT, lw=2.6, solid_capstyle="round", zorder=3.5,
                label=label)  # fmt: skip
        label = None
    if label is None:
        ax.legend(loc="best")


def _colour(scale: Scale, step: int) -> str:
    """The colour of a step of another axis."""
    steps = scale.steps
    norm = (LogNorm if scale.log else Normalize)(float(steps.min()), float(steps.max()))
    return FAMILY(float(norm(steps[step])))  # type: ignore[return-value]


def _explain(ax: Axes, scale: Scale) -> None:
    """A legend of the colours."""
    steps = scale.order[::-1]
    if len(steps) > _MOST_NAMED:
        chosen = np.unique(np.linspace(0, len(steps) - 1, _MOST_NAMED).round().astype(int))
        steps = [steps[at] for at in chosen]
    for step in steps:
        ax.plot([], [], color=_colour(scale, step), label=scale.texts[step])
    title = scale.label.split(",")[0]
    ax.legend(title=title, loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=4)
