"""Tables 2 and 3 again, by the shipped prototype: its speeds beside both printed columns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.nine_rows import predicted
from rr_opt.paper.printed import TABLE_2, TABLE_3, Row
from rr_opt.paper.readings import ABOUT_P
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

AMPLITUDES = np.linspace(0.2, 1.5, 261)
"""Where Table 2's amplitude is looked for, rad."""


@dataclass(frozen=True)
class Regenerated:
    """A printed row with the speed that the model gives it.

    amplitude  alpha, rad; of Table 2 the one that was found
    speed      signed, m/s
    """

    row: Row
    amplitude: float
    speed: float

    @property
    def near_mean(self) -> bool:
        """|speed| is within the printed interval."""
        return abs(abs(self.speed) - self.row.mean) <= self.row.half_width

    @property
    def near_other(self) -> bool:
        """|speed| is within an interval as wide about the other column."""
        return abs(abs(self.speed) - self.row.other) <= self.row.half_width

    @property
    def columns_agree(self) -> bool:
        """The column v_exp is within the printed interval, as the paper concludes."""
        return abs(self.row.other - self.row.mean) <= self.row.half_width


@dataclass(frozen=True)
class Tables:
    """Both tables, and what Table 2's amplitude may be.

    speeds   of Table 2's rows at AMPLITUDES, signed, m/s, (3, n)
    allowed  the amplitudes at which all three rows are within their intervals, as (low, high)
    """

    table2: tuple[Regenerated, ...]
    table3: tuple[Regenerated, ...]
    amplitude: float
    speeds: Array
    allowed: tuple[tuple[float, float], ...]


def regenerate(robot: Robot) -> Tables:
    """Both tables by this robot; J20/J10 about P.

    Table 2's amplitude is the one of AMPLITUDES at which the sum of squares of the misses, in
    half widths, is least: a fit, as the paper does not give it.
    """
    found = np.array([predicted(robot, ABOUT_P, float(one)) for one in AMPLITUDES]).T
    speeds = found[: len(TABLE_2)]
    mean = np.array([[row.mean] for row in TABLE_2])
    width = np.array([[row.half_width] for row in TABLE_2])
    off = (np.abs(speeds) - mean) / width
    best = int(np.nanargmin((off**2).sum(axis=0)))
    inside = np.asarray((np.abs(off) <= 1).all(axis=0))
    at = float(AMPLITUDES[best])
    return Tables(
        tuple(Regenerated(r, at, float(v)) for r, v in zip(TABLE_2, speeds[:, best], strict=True)),
        tuple(
            Regenerated(row, row.amplitude or at, float(v))
            for row, v in zip(TABLE_3, found[len(TABLE_2) :, best], strict=True)
        ),
        at,
        speeds,
        _runs(inside),
    )


def _runs(inside: NDArray[np.bool_]) -> tuple[tuple[float, float], ...]:
    """The ends of each run of amplitudes that are inside."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(int), [0]])))
    return tuple(
        (float(AMPLITUDES[start]), float(AMPLITUDES[end - 1]))
        for start, end in edges.reshape(-1, 2)
    )
