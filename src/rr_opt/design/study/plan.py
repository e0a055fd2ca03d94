"""The order in which the cases of a study are solved, and which neighbouring optima warm-start
each.

A branch is a family of gaits that varies continuously with the inputs. Two neighbouring optima
belong to one branch if a warm start from one leads to the other, or, where this was not tried, if
they look alike: same direction, same active limits and bounds, similar gaits. A branch is a
connected component of these links.

Along each ordered axis the two ends and about every third step between them are anchors. Cases
that are anchors along all axes are solved from cold starts, which search all gaits. Each other
case lies between anchors, next to one along every axis, and is warm-started from their optima. So a
family that is best at three consecutive steps always includes an anchor. Which case warm-starts
which does not depend on the number of processes or on interruptions of the study.
"""

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from rr_opt.design.study.row import CaseOptimum, Row, gait_from
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Interval, Problem

_FACTOR, _OFFSET = 3.0, 0.3
# Between neighbouring optima of one family, amplitudes and periods differ by less than this factor,
# offsets by less than this, rad.


@dataclass(frozen=True)
class Foothold:
    """A warm start: at or between the optima of the neighbours of one family."""

    cases: tuple[int, ...]
    sign: int
    gait: Gait
    share: float


def footholds(donors: Sequence[tuple[int, float]], rows: Mapping[int, Row]) -> list[Foothold]:
    """One foothold for each family among the neighbours' optima, that of the nearest first."""
    families: list[list[tuple[int, float, CaseOptimum]]] = []
    for case, weight in sorted(donors, key=lambda donor: -donor[1]):
        optimum = rows[case].optimum
        if optimum is None:
            continue
        family = next((one for one in families if alike(one[0][2], optimum)), None)
        if family is None:
            families.append([(case, weight, optimum)])
        else:
            family.append((case, weight, optimum))
    return [_between(family) for family in families]


def _between(family: Sequence[tuple[int, float, CaseOptimum]]) -> Foothold:
    """A start from the optima of a family, nearest first, interpolated where possible."""
    cases, given, optima = zip(*family, strict=True)
    nearest = optima[0]
    gait = gait_from(nearest.gait)
    weights = np.array(given) / sum(given)

    def mean(name: str) -> float:
        return float(weights @ [abs(getattr(one, name)) for one in optima])

    def power_mean(name: str) -> float:
        return math.exp(weights @ [math.log(getattr(one, name)) for one in optima])

    if isinstance(gait, SineGait):
        # A gait and its mirror image, phi0 and -phi0, count as the same.
        offset = math.copysign(mean("offset"), gait.offset)
        gait = SineGait(power_mean("amplitude"), power_mean("period"), offset)
    return Foothold(tuple(cases), nearest.sign, gait, mean("share"))


def alike(one: CaseOptimum, other: CaseOptimum) -> bool:
    """Whether optima of neighbouring cases look like one family: same direction, and the same
    active limits and bounds or similar gaits."""

    def near(a: float, b: float) -> bool:
        return max(a, b) < _FACTOR * min(a, b)

    return (
        one.sign == other.sign
        and abs(abs(one.offset) - abs(other.offset)) < _OFFSET
        and (
            one.held == other.held
            or (near(one.amplitude, other.amplitude) and near(one.period, other.period))
        )
    )


def expected_speed(
    problem: Problem,
    donors: Sequence[tuple[int, float]],
    rows: Mapping[int, Row],
    problems: Sequence[Problem],
) -> tuple[float, float] | None:
    """The range of |speed|, m/s, predicted from the neighbours; None if one of them has no optimum.

    It spans the interpolation of their speeds and the extrapolation from each by its shadow prices.
    Both are exact for a family whose speed is a power of the inputs; a speed that is convex or
    concave throughout lies between that chord and those tangents.
    """
    chord = tangents = 0.0
    for case, weight in donors:
        optimum = rows[case].optimum
        if optimum is None:
            return None
        here = math.log(abs(optimum.speed))
        chord += weight * here
        tangents += weight * (here + _gain(optimum, problems[case], problem))
    if not math.isfinite(tangents):
        return None
    return math.exp(min(chord, tangents)), math.exp(max(chord, tangents))


def _gain(optimum: CaseOptimum, here: Problem, there: Problem) -> float:
    """Gain of log |speed|, to first order, as limits and bounds change from one problem to another.

    First order in the logarithms of limits and bounds where these exist, as speeds tend to follow
    power laws.
    """
    moved = [
        (price, getattr(here.limits, name), getattr(there.limits, name))
        for name, price in optimum.prices.items()
        if hasattr(here.limits, name)
    ]
    for name, price in optimum.bound_prices.items():
        side = "low" if f"least {name}" in optimum.held else "high"
        moved.append((price, getattr(_range(here, name), side), getattr(_range(there, name), side)))
    return sum(price * _move(old, new) for price, old, new in moved) / abs(optimum.speed)


def _move(old: float, new: float) -> float:
    if old == new:
        return 0.0
    return old * math.log(new / old) if old > 0 and new > 0 else new - old


def _range(problem: Problem, name: str) -> Interval:
    if name == "inertia_ratio":
        choice = problem.inertia_ratio
        return choice.bounds if choice else Interval(0.0, 0.0)
    return getattr(problem.gait, name)


def branches(rows: Sequence[Row], adjacent: Iterable[tuple[int, int]]) -> list[int | None]:
    """The number of each row's branch, from 1 in the order of the rows; None without an optimum."""
    linked = [(case, other) for case, row in enumerate(rows) for other in row.continued]
    for one, other in adjacent:
        a, b = rows[one], rows[other]
        if a.optimum and b.optimum and other not in a.tried and one not in b.tried:
            linked += [(one, other)] if alike(a.optimum, b.optimum) else []
    ends = np.array(linked, dtype=int).reshape(-1, 2).T
    links = coo_array((np.ones(len(linked)), tuple(ends)), shape=(len(rows), len(rows)))
    numbers: dict[int, int] = {}
    return [
        None if row.optimum is None else numbers.setdefault(member, len(numbers) + 1)
        for row, member in zip(
            rows, connected_components(links, directed=False)[1].tolist(), strict=True
        )
    ]


_STRIDE = 3

Numbers = Sequence[float] | None
"""The values of an axis's steps; None if they have no order, such as words."""


@dataclass(frozen=True)
class Plan:
    """The waves in which cases are solved.

    anchors    cases solved cold, in the first wave
    donors     the anchors around each other case, with their interpolation weights
    adjacent   pairs of cases one step apart along one ordered axis
    """

    anchors: tuple[int, ...]
    donors: dict[int, tuple[tuple[int, float], ...]]
    adjacent: tuple[tuple[int, int], ...]


def plan(axes: Sequence[Numbers], shape: Sequence[int]) -> Plan:
    """The plan for the product of axes with these numbers of steps, the last one fastest."""
    around = [_around(numbers, count) for numbers, count in zip(axes, shape, strict=True)]
    anchors: list[int] = []
    donors: dict[int, tuple[tuple[int, float], ...]] = {}
    for case, steps in enumerate(itertools.product(*map(range, shape))):
        corners = [
            (
                int(np.ravel_multi_index([step for step, _ in corner], shape)),
                math.prod(w for _, w in corner),
            )
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
    """For each step of an axis, the anchors around it, or itself if it is one, with weights."""
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
    """Fractional position of a value in a range, 0 to 1: logarithmic where possible."""
    if low > 0:
        low, value, high = math.log(low), math.log(value), math.log(high)
    width = high - low
    return (value - low) / width if 0 < width < math.inf else 0.5


def _adjacent(axes: Sequence[Numbers], shape: Sequence[int]) -> Iterator[tuple[int, int]]:
    after: list[dict[int, int]] = []
    for numbers, count in zip(axes, shape, strict=True):
        order = sorted(range(count), key=lambda step, n=numbers: n[step] if n else step)
        after.append(dict(itertools.pairwise(order)) if numbers is not None else {})
    for case, steps in enumerate(itertools.product(*map(range, shape))):
        for axis, step in enumerate(steps):
            if step in after[axis]:
                beyond = [*steps[:axis], after[axis][step], *steps[axis + 1 :]]
                yield case, int(np.ravel_multi_index(beyond, shape))
