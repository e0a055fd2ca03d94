"""(b) What Table 1 leaves out."""

from __future__ import annotations

from rr_opt.paper.consistency import wheel_for
from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit.section import Section
from rr_opt.report.quantities import number


def left_out_section(found: Reproduction) -> Section:
    """The unknowns, and how much a speed hangs on each."""
    row, tables = found.start.row, found.tables
    spans = " or ".join(
        f"{number(low, 3)} to {number(high, 3)} rad" for low, high in tables.allowed
    )
    spread = sorted(found.left_out, key=lambda one: one.least / one.largest)
    told = ", ".join(
        f"{one.name} from {number(1e3 * one.least, 3)} to {number(1e3 * one.largest, 3)} mm/s"
        for one in spread
    )
    return Section(
        "left-out",
        "What Table 1 leaves out",
        "The speeds cannot be computed from what is printed.",
        (
            "Not given: c1, a1, c2 and a2 apart (only c1 - a1 and c2 - a2), the half tracks b1 and "
            "b2, the wheel radius h, the unit of kappa = 0.25, the amplitude of Table 2, and at "
            "which J20/J10 Fig. 3 was driven. h matters only through k = kappa/h^2.",
            f"At amplitude {number(row.amplitude or 0.0)} rad, period {number(row.period)} s and "
            f"J20/J10 = {number(row.ratio)}, moving one unknown of the shipped prototype over its "
            f"box and leaving the others moves the speed: {told}.",
            f"Friction is therefore a fit and no measurement, here k = {number(found.robot.k1, 3)} "
            "N s/m per wheel. Read as 0.25 mN m s, the printed kappa gives this k with wheels of "
            f"{number(1e3 * wheel_for(found.robot.k1), 3)} mm radius, which the paper does not "
            "say.",
            "With the shipped prototype all three rows of Table 2 are within their intervals for "
            f"amplitudes of {spans or 'no value'}; the best is {number(tables.amplitude, 3)} rad.",
        ),
        ("unknown", "unit", "assumed", "box from", "box to", "least speed, m/s",
         "largest speed, m/s"),
        tuple(
            (one.name, one.unit, one.assumed, one.low, one.high, one.least, one.largest)
            for one in found.left_out
        ),
    )  # fmt: skip
