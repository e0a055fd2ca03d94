"""Which cases' optima are one branch: one family of gaits that changes as the inputs do.

Two neighbouring optima are of one branch if solving the one case from the other's optimum leads
to its own, or, where this was not tried, if they look alike: the same direction, held by the same
limits and bounds, their gaits near each other. A branch is all that is linked in this way.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rr_opt.design.study.neighbours import alike
from rr_opt.design.study.row import Row


def branches(rows: Sequence[Row], adjacent: Iterable[tuple[int, int]]) -> list[int | None]:
    """The number of each row's branch, from 1 in the order of the rows; None without optimum."""
    parent = list(range(len(rows)))

    def root(case: int) -> int:
        while parent[case] != case:
            parent[case] = parent[parent[case]]
            case = parent[case]
        return case

    for case, row in enumerate(rows):
        for other in row.continued:
            parent[root(case)] = root(other)
    for one, other in adjacent:
        if _untried(rows, one, other) and _alike(rows[one], rows[other]):
            parent[root(one)] = root(other)
    numbers: dict[int, int] = {}
    return [
        None if row.optimum is None else numbers.setdefault(root(case), len(numbers) + 1)
        for case, row in enumerate(rows)
    ]


def _untried(rows: Sequence[Row], one: int, other: int) -> bool:
    return other not in rows[one].tried and one not in rows[other].tried


def _alike(one: Row, other: Row) -> bool:
    return (
        one.optimum is not None and other.optimum is not None and alike(one.optimum, other.optimum)
    )
