"""(f) The 1/T^2 law against the measured ratios."""

from __future__ import annotations

import math

from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit.section import Section
from rr_opt.report.quantities import number


def period_section(found: Reproduction) -> Section:
    """What the period does to the speed."""
    law = found.period
    all_robots, printed = law.spreads
    inside = sum(one.low <= one.model <= one.high for one in law.ratios)
    means = ", ".join(f"{number(one.mean, 3)} ({_span(one.low, one.high)})" for one in law.ratios)
    others = [one.other for one in law.ratios]
    most = max(one.largest for one in law.spreads)
    above = sum(one > most for one in others)
    swapped = ", ".join(_span(one.other_low, one.other_high) for one in law.ratios)
    outside = sum(one.other_low > most for one in law.ratios)
    return Section(
        "period",
        "Speed falls as 1/T^2 with viscous friction; do the tables?",
        "The column with intervals neither confirms nor excludes the law. The column v_exp breaks "
        "it: it is no simulation with one viscous friction.",
        (
            "With viscous friction the speed at a fixed amplitude goes nearly as 1/T^2, so "
            "v(1 s)/v(2 s) is near 4 whatever the unknowns: over "
            f"{all_robots.robots} random robots of the box and amplitudes of Table 3's range its "
            f"median is {number(all_robots.q50, 3)}, 90 % lie within {number(all_robots.q05, 3)} "
            f"and {number(all_robots.q95, 3)}, and the largest is {number(all_robots.largest, 3)}. "
            f"With the signs as printed: {number(printed.q50, 3)}, {number(printed.q05, 3)} to "
            f"{number(printed.q95, 3)}, at most {number(printed.largest, 3)}.",
            f"Measured (the mean column, with Fieller's 95 % interval): {means}. The model's own "
            f"ratio is within {inside} of {len(law.ratios)} intervals. The ratios grow with the "
            "amplitude, as dry friction would have it, but the intervals do not force that.",
            f"v_exp: {', '.join(number(one, 3) for one in others)}. {above} of them are beyond "
            "anything that viscous friction gave, with these signs or those. If this column is the "
            "simulation, its friction was not the viscous one of section 2, or k was fitted for "
            "each run anew. If it is the measured one and the intervals are its own, its ratios "
            f"are {swapped}: {outside} of {len(law.ratios)} leave out {number(most, 3)}, the "
            "largest of all.",
        ),
        ("amplitude, rad", "model", "mean", "mean from", "mean to", "v_exp", "v_exp from",
         "v_exp to"),
        tuple(
            (one.amplitude, one.model, one.mean, one.low, one.high, one.other,
             one.other_low, one.other_high)
            for one in law.ratios
        ),
    )  # fmt: skip


def _span(low: float, high: float) -> str:
    if math.isinf(high):
        return f"above {number(low, 3)}"
    return f"{number(low, 3)} to {number(high, 3)}"
