"""Rows put in the order of their times, those that stand there twice left out."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_RESTARTS = 5
"""A file whose time falls back less often, and by more rows than this at once, was joined."""


@dataclass(frozen=True)
class Order:
    """Rows in the order of their times.

    rows    (m,) indices of the rows that are kept
    moved   (m,) of those, which stood in another place
    unsure  (m,) of those, which share their time with a row that says something else
    """

    rows: NDArray[np.int64]
    moved: NDArray[np.bool_]
    unsure: NDArray[np.bool_]
    doubts: tuple[str, ...]


def in_order(t: Array, values: Array, lines: Sequence[int] | NDArray[np.int64]) -> Order:
    """The order of rows with the times t (n,) and values (n, ...), which stand at some lines.

    A row without a time has no place. Of rows with one time the first is kept.
    """
    doubts: list[str] = []
    lines = np.asarray(lines)
    rows = np.flatnonzero(np.isfinite(t))
    lost = lines[~np.isfinite(t)]
    if len(lost):
        doubts.append(f"Without a time, and so left out: {_rows(lost)}.")
    moved = np.zeros(len(rows), bool)
    if (np.diff(t[rows]) < 0).any():
        moved = ~_longest_rising(t[rows])
        doubts.append(f"Out of order, and put where the time says: {_rows(lines[rows[moved]])}.")
        back = np.flatnonzero(np.diff(t[rows]) < 0)
        if len(back) < _RESTARTS and moved.sum() > _RESTARTS * len(back):
            at = rows[back[0]], rows[back[0] + 1]
            doubts.append(
                f"The time falls back from {t[at[0]]:.6g} to {t[at[1]]:.6g} s in line "
                f"{lines[at[1]]}: two recordings in one file, or a clock that was set? Part them."
            )
        order = np.argsort(t[rows], kind="stable")
        rows, moved = rows[order], moved[order]
    again = np.diff(t[rows], prepend=np.nan) == 0
    unsure = np.zeros(len(rows), bool)
    if again.any():
        doubts.append(
            f"With the time of another row, and so left out: {_rows(lines[rows[again]])}."
        )
        kept = np.flatnonzero(~again)[np.cumsum(~again) - 1]
        mine, first = (
            values[rows[which]].reshape(again.sum(), -1) for which in (again, kept[again])
        )
        same = (mine == first) | (np.isnan(mine) & np.isnan(first))
        unsure[kept[again][~same.all(axis=1)]] = True
        if unsure.any():
            doubts.append(
                f"{unsure.sum()} of the times have rows that say different things; none of them "
                "was taken as data."
            )
    keep = ~again
    return Order(rows[keep], moved[keep], unsure[keep], tuple(doubts))


def _rows(lines: NDArray[np.int64]) -> str:
    if len(lines) == 1:
        return f"line {lines[0]}"
    return f"{len(lines)} rows, the first in line {min(lines)}"


def _longest_rising(t: Array) -> NDArray[np.bool_]:
    """Members of a longest sequence that does not fall: the fewest others came out of order."""
    tails: list[float] = []
    ends: list[int] = []
    before = np.full(len(t), -1)
    for at, time in enumerate(t.tolist()):
        place = bisect_right(tails, time)
        before[at] = ends[place - 1] if place else -1
        tails[place : place + 1] = [time]
        ends[place : place + 1] = [at]
    member = np.zeros(len(t), bool)
    at = ends[-1]
    while at >= 0:
        member[at] = True
        at = before[at]
    return member
