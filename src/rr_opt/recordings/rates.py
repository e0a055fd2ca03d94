"""The rate at which rows come, and what is odd about it: jumps, unevenness, another one stated."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.refusal import refuse

Array = NDArray[np.float64]

_JUMP = 1.5
"""Steps longer than this, in usual steps, lack a row."""
_UNEVEN = 0.2
"""Steps that differ by more from the usual one, relative to it, are told."""
_OTHER_RATE = 2e-3
"""A rate that differs by more from the one stated, relative to it, is told."""
_LISTED = 3
SLOWEST, FASTEST = 1e-3, 1e6
"""Rates beyond these are taken for a slip of the unit, or for damage, Hz."""


def rate_of(t: Array, file: str, line: int | None = None) -> float:
    """Rows per second, Hz, of increasing times: by the steps that lack no row.

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
    # As far below the usual step as above it, so that times that jitter have their mean rate.
    middle = np.median(steps)
    usual = steps[np.abs(steps / middle - 1) <= _JUMP - 0.99]
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


def time_doubts(t: Array, rate: float, stated: float | None = None) -> tuple[str, ...]:
    """What is odd about increasing times (n >= 2) that come at a rate, Hz; stated: by a header."""
    doubts = []
    steps = np.diff(t) * rate
    # Where a row is lacking the steps about it do not make up for it, as they do for a late one.
    around = np.convolve(np.concatenate([[1.0], steps, [1.0]]), np.ones(3), "valid")
    jumps = np.flatnonzero((steps > _JUMP) & (around > _JUMP + 2))
    if len(jumps):
        listed = ", ".join(
            f"{steps[at] / rate:.4g} s at t = {t[at]:.6g} s" for at in jumps[:_LISTED]
        )
        more = ", ..." if len(jumps) > _LISTED else ""
        lacking = int(np.round(steps[jumps] - 1).sum())
        doubts.append(
            f"The time jumps {_times(len(jumps))} ({listed}{more}): at {rate:.5g} Hz about "
            f"{lacking} rows are missing."
        )
    usual = np.delete(steps, jumps)
    uneven = np.abs(usual - 1) > _UNEVEN + 1.01 * _printed(t) * rate
    if uneven.any():
        doubts.append(
            f"The rows do not come at a constant rate: {uneven.sum()} of {len(usual)} steps differ "
            f"by more than {100 * _UNEVEN:.0f} % from {1000 / rate:.4g} ms."
        )
    if stated is not None and abs(rate / stated - 1) > _OTHER_RATE:
        doubts.append(
            f"The header states {stated:.6g} Hz, and the times come at {rate:.6g} Hz. The times "
            "were taken."
        )
    return tuple(doubts)


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def _printed(t: Array) -> float:
    """The last decimal that the times were printed with, s; 0 if they are not rounded."""
    for digits in range(7):
        if np.abs(t * 10**digits - np.round(t * 10**digits)).max() < 1e-4:
            return 10.0**-digits
    return 0.0
