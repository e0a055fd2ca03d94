"""The two axes of a study that a map is drawn over, and which case a place of the map shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from rr_opt.report.figures.study.axis import Shown, shown
from rr_opt.report.study.result import Studied

Array = NDArray[np.float64]

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


def grid_of(result: Studied) -> Grid | None:
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
