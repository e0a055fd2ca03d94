"""From a good grid point to the best one near it: grids that follow the best and shrink."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.problem import Problem
from rr_opt.verify.evaluate import Found, evaluate
from rr_opt.verify.grid import DECISIONS, Grid, boxes

Array = NDArray[np.float64]

_VALUES = {1: 5, 2: 5, 3: 3, 4: 3}
"""Values of each decision in a grid, by how many are free."""

_ROUNDS = 60


@dataclass(frozen=True)
class Zoomed:
    """best: None if no point near the start keeps all limits; points: evaluated in all."""

    best: Found | None
    points: int


def local_grid(
    problem: Problem, centre: Mapping[str, float | None], widths: Mapping[str, float], count: int
) -> Grid:
    """`count` values of each decision within `widths` of the centre and within the bounds."""
    inside = boxes(problem)

    def around(name: str) -> Array:
        middle = centre[name]
        if middle is None:
            return np.array([])
        box, width = inside[name], widths.get(name, 0.0)
        if box.fixed or width == 0.0:
            return np.array([box.clip(middle)])
        return np.unique(np.clip(middle + width * np.linspace(-1, 1, count), box.low, box.high))

    ratio = None
    if centre["ratio"] is not None:
        ratio = np.array([centre["ratio"]]) if _whole(problem) else around("ratio")
    return Grid(around("amplitude"), around("period"), around("offset"), ratio)


def zoom(
    problem: Problem,
    start: Found,
    widths: Mapping[str, float],
    tolerance: float,
    least: float,
    first: int = 0,
) -> Zoomed:
    """Climb from a start by grids around the best point so far.

    widths: of the first grid to either side of the start, by free decision; `first`: values of
    each in it.
    A grid whose best point lies inside is followed by one half as wide, until it is `least` of
    the first; one whose best is on its rim, by one around that.
    tolerance: of the speeds, relative.
    """
    best, points, share = None, 0, 1.0
    usual = _VALUES.get(len(widths), 1)
    count = first or usual
    centre = _values(start)
    for _ in range(_ROUNDS):
        around = {name: share * width for name, width in widths.items()}
        found = evaluate(problem, local_grid(problem, centre, around, count), tolerance)
        points, count = points + found.speed.size, usual
        merit = found.merit
        top = int(merit.argmax()) if merit.size else -1
        if top < 0 or merit[top] == -np.inf:
            break
        if best is None or merit[top] >= abs(best.speed):
            best = found.found(top)
        moved = _values(best)
        on_rim = any(
            abs(_gap(moved[name], centre[name])) > 0.75 * width for name, width in around.items()
        )
        centre = moved
        if not on_rim:
            share /= 2
        if share < least:
            break
    return Zoomed(best, points)


def _values(found: Found) -> dict[str, float | None]:
    gait = found.gait
    values = (gait.amplitude, gait.period, gait.offset, found.ratio)
    return dict(zip(DECISIONS, values, strict=True))


def _gap(one: float | None, other: float | None) -> float:
    return 0.0 if one is None or other is None else one - other


def _whole(problem: Problem) -> bool:
    choice = problem.inertia_ratio
    return choice is not None and choice.by == "loads" and choice.loads.whole
