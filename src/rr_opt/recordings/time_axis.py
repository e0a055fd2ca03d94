"""The times of a recording: in order, at which rate, and what is odd about them."""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.files.issue import refuse
from rr_opt.recordings.warnings import Notice, notice


def time_step(t: Array) -> float:
    """The usual time between samples, s; 1 where there are too few samples."""
    step = np.diff(t)
    step = step[step > 0]
    return float(np.median(step)) if len(step) else 1.0


_FARTHEST = 1e3
"""Neighbours count as at most this many steps apart: farther ones say nothing about each other, and
accuracy would suffer."""


def in_steps(t: Array) -> Array:
    """Increasing times (n,) in usual steps, from 0; longer gaps count as a thousand steps."""
    return np.concatenate([[0.0], np.cumsum(np.minimum(np.diff(t) / time_step(t), _FARTHEST))])


LATEST = 1e12
"""Larger times belong to no clock, in any unit, s."""
_TOGETHER = 1e-9
"""Times closer than this are the same for any clock, s."""
_RESTARTS = 5
"""A file whose time falls back fewer times than this, each by more rows than this, was joined."""


@dataclass(frozen=True)
class Order:
    """Rows in the order of their times.

    rows    (m,) indices of the rows that are kept
    moved   (m,) which of these stood in another place
    unsure  (m,) which of these share their time with a row of other values
    """

    rows: NDArray[np.int64]
    moved: NDArray[np.bool_]
    unsure: NDArray[np.bool_]
    doubts: tuple[Notice, ...]


def in_order(t: Array, values: Array, lines: Sequence[int] | NDArray[np.int64]) -> Order:
    """The order of rows with the times t (n,) and values (n, ...), which stand at some lines.

    A row without a time, or with one that no clock shows, is dropped. Of rows with the same time
    the first is kept.
    """
    doubts: list[Notice] = []
    lines = np.asarray(lines)
    timed = np.abs(t) < LATEST
    rows, lost = np.flatnonzero(timed), lines[~timed]
    if len(lost):
        doubts.append(notice("time.none", rows=_rows(lost)))
    moved = np.zeros(len(rows), bool)
    if (np.diff(t[rows]) < 0).any():
        moved = ~longest_rising(t[rows])
        doubts.append(notice("time.order", rows=_rows(lines[rows[moved]])))
        back = np.flatnonzero(np.diff(t[rows]) < 0)
        if len(back) < _RESTARTS and moved.sum() > _RESTARTS * len(back):
            before, after = rows[back[0]], rows[back[0] + 1]
            doubts.append(
                notice("time.restart", before=t[before], after=t[after], line=lines[after])
            )
        order = np.argsort(t[rows], kind="stable")
        rows, moved = rows[order], moved[order]
    again = np.diff(t[rows], prepend=-np.inf) < _TOGETHER
    unsure = np.zeros(len(rows), bool)
    if again.any():
        doubts.append(notice("time.twice", rows=_rows(lines[rows[again]])))
        kept = np.flatnonzero(~again)[np.cumsum(~again) - 1]
        mine, first = (
            values[rows[which]].reshape(again.sum(), -1) for which in (again, kept[again])
        )
        same = (mine == first) | (np.isnan(mine) & np.isnan(first))
        unsure[kept[again][~same.all(axis=1)]] = True
        if unsure.any():
            doubts.append(notice("time.conflict", count=unsure.sum()))
    keep = ~again
    return Order(rows[keep], moved[keep], unsure[keep], tuple(doubts))


def _rows(lines: NDArray[np.int64]) -> str:
    if len(lines) == 1:
        return f"line {lines[0]}"
    return f"{len(lines)} rows, the first in line {min(lines)}"


def longest_rising(t: Array) -> NDArray[np.bool_]:
    """Members of a longest non-decreasing sequence; the others came out of order."""
    tails: list[float] = []
    ends: list[int] = []
    before = np.full(len(t), -1)
    for at, time in enumerate(t.tolist()):
        place = bisect_right(tails, time)
        before[at] = ends[place - 1] if place else -1
        tails[place : place + 1] = [time]
        ends[place : place + 1] = [at]
    member = np.zeros(len(t), bool)
    at = ends[-1] if ends else -1
    while at >= 0:
        member[at] = True
        at = before[at]
    return member


LACKING = 1.5
"""Steps longer than this, in usual steps, are missing a row."""
_UNEVEN = 0.2
"""Steps that differ by more from the usual one, relative to it, are reported."""
_OTHER_RATE = 2e-3
"""A rate that differs by more from the one stated, relative to it, is reported."""
_LISTED = 3
SLOWEST, FASTEST = 1e-3, 1e6
"""Rates beyond these are taken for a wrong unit, or for damage, Hz."""


def rate_of(t: Array, file: str, line: int | None = None) -> float:
    """Rows per second, Hz, of increasing times, from steps without missing rows.

    Raises InvalidFileError, naming the file and a line, for fewer than two rows and for a rate that
    no recording has.
    """
    if len(t) < 2:
        rows = "1 row" if len(t) else "no row"
        refuse(
            file,
            f"Read {rows} with a time. Expected at least 2: a single one shows no motion. "
            "Export the whole recording.",
            line,
        )
    steps = np.diff(t)
    # Cut off symmetrically about the usual step, so that jittering times have their mean rate.
    middle = np.median(steps)
    usual = steps[np.abs(steps / middle - 1) <= LACKING - 0.99]
    usual = usual if len(usual) else steps[steps <= middle]
    with np.errstate(over="ignore"):
        rate = float(len(usual) / usual.sum())
    check_rate(rate, file, line)
    return rate


def check_rate(rate: float, file: str, line: int | None = None) -> None:
    """Raise InvalidFileError for a rate, Hz, that no recording has."""
    if not SLOWEST <= rate <= FASTEST:
        refuse(
            file,
            f"Read a rate of {rate:.4g} Hz. Expected {SLOWEST:g} to {FASTEST:g} Hz, with times in "
            "seconds. Correct the times, or the rate in the header.",
            line,
        )


def jumping(steps: Array) -> NDArray[np.bool_]:
    """Whether rows are missing within each step, counted in usual ones. The steps about a late row
    compensate for it; those about a missing one do not."""
    around = np.convolve(np.concatenate([[1.0], steps, [1.0]]), np.ones(3), "valid")
    return (steps > LACKING) & (around > LACKING + 2)


def time_notices(t: Array, rate: float, stated: float | None = None) -> Iterator[Notice]:
    """What is odd about increasing times (n >= 2) that come at a rate, Hz; stated: by a header."""
    steps = np.diff(t) * rate
    jumps = np.flatnonzero(jumping(steps))
    if len(jumps):
        listed = ", ".join(
            f"{steps[at] / rate:.4g} s at t = {t[at]:.6g} s" for at in jumps[:_LISTED]
        )
        yield notice(
            "time.jump",
            often="once" if len(jumps) == 1 else f"{len(jumps)} times",
            listed=listed + (", ..." if len(jumps) > _LISTED else ""),
            rate=rate,
            lacking=int(np.round(steps[jumps] - 1).sum()),
        )
    usual = np.delete(steps, jumps)
    uneven = int((np.abs(usual - 1) > _UNEVEN + 1.01 * _printed(t) * rate).sum())
    if uneven:
        most, step = 100 * _UNEVEN, 1000 / rate
        yield notice("time.uneven", uneven=uneven, count=len(usual), most=most, usual=step)
    if stated is not None and abs(rate / stated - 1) > _OTHER_RATE:
        yield notice("time.rate", stated=stated, rate=rate)


def _printed(t: Array) -> float:
    """The last decimal that the times were printed with, s; 0 if they are not rounded."""
    for digits in range(7):
        if np.abs(t * 10**digits - np.round(t * 10**digits)).max() < 1e-4:
            return 10.0**-digits
    return 0.0
