"""What a study varies as the axes of a figure: one axis, and the map over two."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.files.study_axes import Axis
from rr_opt.formatting import number
from rr_opt.results.study import SolvedStudy
from rr_opt.results.study_table import axis_words, unit_of, value_text

_EVEN = 0.05
_WIDEST = 60
"""Letters of names that fit side by side under a figure."""


@dataclass(frozen=True)
class Scale:
    """The steps of an axis in the unit that people think in, and their names.

    factor   how many of that unit are one SI unit
    ordered  steps are numbers with a place on a scale, logarithmic if `log`. If one is none, or is
             infinite, they are named and stand side by side, at 1, 2, 3 ..: the finite ones by
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
            # At the steps themselves, at most six of them: powers of ten alone are too few.
            ordered = np.sort(self.steps)
            chosen = ordered[np.unique(np.linspace(0, len(ordered) - 1, 6).round().astype(int))]
            ticks(chosen, [number(step, 2) for step in chosen])
            ticks([], minor=True)
        if not self.ordered:
            slant = which == "x" and sum(map(len, self.texts)) > _WIDEST
            style = {"rotation": 30, "ha": "right", "rotation_mode": "anchor"} if slant else {}
            ticks(self.steps, self.texts, **style)


def scale_of(axis: Axis) -> Scale:
    """How to show an axis; keys that are varied in step are shown by the first."""
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
    """cases (Y, X): of those that share a place, that with the fastest optimum."""

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
