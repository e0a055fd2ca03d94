"""Text for a terminal: columns, and the lines that tell a gait."""

from __future__ import annotations

from collections.abc import Sequence

from rr_opt.report.quantities import QUANTITIES, with_unit
from rr_opt.robot.gait import SineGait


def gait_lines(gait: SineGait) -> list[tuple[str, ...]]:
    """Amplitude, period and offset with their units, a row each."""
    return [
        ("  amplitude", QUANTITIES["amplitude"].both(gait.amplitude)),
        ("  period", f"{with_unit(gait.period, 's')} ({with_unit(1 / gait.period, 'Hz')})"),
        ("  offset", QUANTITIES["offset"].both(gait.offset)),
    ]


def columns(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Rows of cells in columns as wide as their widest cell, at least 8."""
    if not rows:
        return []
    count = max(len(row) for row in rows)
    widths = [max([6, *(len(row[i]) for row in rows if i < len(row) - 1)]) for i in range(count)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
