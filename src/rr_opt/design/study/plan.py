"""In which order the cases of a study are solved, and from whose optima.

Along each ordered axis the two ends and about every third step between them are anchors. Cases
that are anchors along all axes are solved from cold starts, which look at every gait. Each other
case lies between anchors, next to one along every axis, and is continued from their optima. So a
family of optima that is the best at three steps in a row is met by an anchor. Which case is
solved from which does not depend on how many processes work or on how often the study was
interrupted.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

_STRIDE = 3

Numbers = Sequence[float] | None
"""Where the steps of an axis lie; None if they have no order, such as words."""


@dataclass(frozen=True)
class Plan:
    """The waves in which cases are solved.

    anchors    cases solved cold, in the first wave
    donors     the anchors about each other case, with their weights in interpolation
    adjacent   pairs of cases one step apart along one ordered axis
    """

    anchors: tuple[int, ...]
    donors: dict[int, tuple[tuple[int, float], ...]]
    adjacent: tuple[tuple[int, int], ...]


def plan(axes: Sequence[Numbers], shape: Sequence[int]) -> Plan:
    """The plan for the product of axes with so many steps each, the last one fastest."""
    around = [_around(numbers, count) for numbers, count in zip(axes, shape, strict=True)]
    anchors: list[int] = []
    donors: dict[int, tuple[tuple[int, float], ...]] = {}
    for case, steps in enumerate(itertools.product(*map(range, shape))):
        corners = [
            (_case([step for step, _ in corner], shape), math.prod(w for _, w in corner))
            for corner in itertools.product(
                *(about[step] for about, step in zip(around, steps, strict=True))
            )
        ]
        if corners[0][0] == case:
            anchors.append(case)
        else:
            donors[case] = tuple(corners)
    return Plan(tuple(anchors), donors, tuple(_adjacent(axes, shape)))


def _around(numbers: Numbers, count: int) -> list[list[tuple[int, float]]]:
    """For each step of an axis the anchors about it, itself alone if it is one, with weights."""
    if numbers is None:
        return [[(step, 1.0)] for step in range(count)]
    order = sorted(range(count), key=lambda step: numbers[step])
    spans = max(math.ceil((count - 1) / _STRIDE), 1)
    places = sorted({round(span * (count - 1) / spans) for span in range(spans + 1)})
    around: list[list[tuple[int, float]]] = [[] for _ in range(count)]
    for place, step in enumerate(order):
        below = order[max(at for at in places if at <= place)]
        above = order[min(at for at in places if at >= place)]
        part = _part(numbers[below], numbers[step], numbers[above])
        around[step] = [(above, 1.0)] if above == below else [(below, 1 - part), (above, part)]
    return around


def _part(low: float, value: float, high: float) -> float:
    """How far along a range a value is, 0 to 1: on a logarithmic scale if it has one."""
    if low > 0:
        low, value, high = math.log(low), math.log(value), math.log(high)
    width = high - low
    return (value - low) / width if 0 < width < math.inf else 0.5


def _case(steps: Sequence[int], shape: Sequence[int]) -> int:
    case = 0
    for step, length in zip(steps, shape, strict=True):
        case = case * length + step
    return case


def _adjacent(axes: Sequence[Numbers], shape: Sequence[int]) -> Iterator[tuple[int, int]]:
    after: list[dict[int, int]] = []
    for numbers, count in zip(axes, shape, strict=True):
        order = sorted(range(count), key=lambda step, n=numbers: n[step] if n else step)
        after.append(dict(itertools.pairwise(order)) if numbers is not None else {})
    for case, steps in enumerate(itertools.product(*map(range, shape))):
        for axis, step in enumerate(steps):
            if step in after[axis]:
                beyond = [*steps[:axis], after[axis][step], *steps[axis + 1 :]]
                yield case, _case(beyond, shape)
