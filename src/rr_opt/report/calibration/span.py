"""Intervals as text, in the unit in which an unknown is told."""

from __future__ import annotations

from rr_opt.paper.calibration.unknowns import Unknown
from rr_opt.report.quantities import number


def span(unknown: Unknown, ends: tuple[float, float], digits: int = 2) -> str:
    """`-28 to 5 mm`; ends in SI."""
    low, high = (number(float(unknown.shown(end)), digits) for end in ends)
    return f"{low} to {high} {unknown.shown_unit}"
