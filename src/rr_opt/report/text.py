"""Text for a terminal: columns, and the lines that tell a gait."""

from __future__ import annotations

from collections.abc import Sequence

from rr_opt.answers.quantities import QUANTITIES, with_unit
from rr_opt.model.gait import FourierGait, FreeGait, Gait

_NOTHING = 1e-4
"""A coefficient so small, relative to the largest, is what an optimiser leaves of 0."""


def gait_formula(gait: Gait) -> str:
    """What phi(t) is made of."""
    if isinstance(gait, FourierGait):
        return f"phi(t) = offset + {gait.harmonics} harmonics of the period"
    if isinstance(gait, FreeGait):
        return f"phi(t) with a constant acceleration on each of {gait.pieces} intervals"
    return "phi(t) = amplitude sin(2 pi t/period) + offset"


def gait_lines(gait: Gait) -> list[tuple[str, ...]]:
    """Amplitude, period, offset and, of a Fourier gait, the harmonics, a row each."""
    rows = [
        ("  amplitude", QUANTITIES["amplitude"].both(gait.amplitude)),
        ("  period", f"{with_unit(gait.period, 's')} ({with_unit(1 / gait.period, 'Hz')})"),
        ("  offset", QUANTITIES["offset"].both(gait.offset)),
    ]
    if isinstance(gait, FourierGait):
        least = _NOTHING * max(map(abs, gait.sines + gait.cosines))
        for n, sizes in enumerate(zip(gait.sines, gait.cosines, strict=True), 1):
            sine, cosine = (with_unit(size if abs(size) >= least else 0, "rad") for size in sizes)
            rows.append((f"  harmonic {n}", f"{sine} of the sine, {cosine} of the cosine"))
    return rows


def columns(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Rows of cells in columns as wide as their widest cell, at least 8."""
    if not rows:
        return []
    count = max(len(row) for row in rows)
    widths = [max([6, *(len(row[i]) for row in rows if i < len(row) - 1)]) for i in range(count)]
    return ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
