"""Pieces of text about intervals that the summary, the page and the record share."""

from __future__ import annotations

from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.intervals import Interval, correlation, given, intervals
from rr_opt.paper.calibration.measured import Column
from rr_opt.paper.calibration.profile import Profile
from rr_opt.paper.calibration.robots import READINGS
from rr_opt.paper.calibration.shipped import JOINT_LEVEL, shipped_values
from rr_opt.paper.calibration.unknowns import Unknown
from rr_opt.report.calibration.span import span
from rr_opt.report.calibration.words import IF_MEASURED
from rr_opt.report.quantities import number


def box(unknown: Unknown) -> str:
    """The box as text."""
    return span(unknown, (unknown.low, unknown.high))


def profile_span(one: Interval, profile: Profile) -> str:
    """A profile's interval; `open` where the box ends it."""
    ends = [word for word, is_open in (("below", profile.open_below), ("above", profile.open_above))
            if is_open]  # fmt: skip
    told = span(one.unknown, one.of(profile))
    return f"{told} (open {' and '.join(ends)})" if ends else told


def valley(found: Calibration, column: Column) -> str:
    """What the rows pin down in the place of single values."""
    low, high = given(found, column, "a2", 0.0, 1e-3, "k")
    return (
        f"a2 and log k are tied (correlation {correlation(found, column, 'a2', 'k'):.2f}): if a2 "
        f"were measured as 0 to within 1 mm, k would lie in {number(low, 2)} to "
        f"{number(high, 2)} N s/m."
    )


def shipped_text(found: Calibration, column: Column) -> str:
    """Whether the shipped robot's values lie inside, one by one and together."""
    values, here = shipped_values(), found.shipped[column]
    outside = [
        one.unknown.symbol
        for one in intervals(found)
        if one.column == column
        and one.unknown.name in values
        and not one.holds(values[one.unknown.name])
    ]
    each = f"{', '.join(outside)} outside its interval" if outside else "each inside its interval"
    rises = [f"{here.rise:.1f} ({READINGS[0].words})"]
    rises += [
        f"{other.shipped.rise:.1f} ({other.reading.words})"
        for other in found.alternatives
        if other.column == column and other.shipped
    ]
    return (
        f"The shipped robot's a1, a2, b and k, {IF_MEASURED[column]}: {each}. Together they raise "
        f"the deviance by {', '.join(rises)}; {JOINT_LEVEL:.1f} is where a joint 95 % region "
        "would end if four unknowns had many data."
    )
