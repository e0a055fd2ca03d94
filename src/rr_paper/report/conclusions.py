"""The calibration in sentences, each with its numbers."""

from __future__ import annotations

from rr_opt.answers.quantities import number
from rr_paper.calibration.calibration import JOINT_LEVEL, Calibration, Interval, shipped_values
from rr_paper.calibration.comparison import AICc
from rr_paper.calibration.intervals import Profile
from rr_paper.calibration.models import DRY, READINGS, VISCOUS
from rr_paper.calibration.unknowns import UNKNOWNS, Unknown
from rr_paper.publication import COLUMNS, Column

SHORT: dict[Column, str] = {"mean": "first column", "other": "v_exp"}
IF_MEASURED: dict[Column, str] = {
    "mean": "if the first column was measured",
    "other": "if v_exp was measured",
}


def span(unknown: Unknown, ends: tuple[float, float], digits: int = 2) -> str:
    """`-28 to 5 mm`; ends in SI."""
    low, high = (number(float(unknown.shown(end)), digits) for end in ends)
    return f"{low} to {high} {unknown.shown_unit}"


def box(unknown: Unknown) -> str:
    """The box as text."""
    return span(unknown, (unknown.low, unknown.high))


def profile_span(one: Interval, profile: Profile) -> str:
    """A profile's interval; `open` where the box ends it."""
    below, above = profile.low <= 0, profile.high >= 1
    if below and above:
        return "whole box"
    open_side = " (open below)" if below else " (open above)" if above else ""
    return span(one.unknown, profile.ends(one.unknown)) + open_side


def aicc_text(aicc: AICc) -> str:
    """The criterion to a tenth; `undefined` where there are too few rows."""
    return "undefined" if aicc.value is None else f"{aicc.value:.1f}"


def verdict(found: Calibration) -> str:
    """The comparison in a headline."""
    of = found.assessments
    if all(
        of[DRY, column].left_out_deviance < of[VISCOUS, column].left_out_deviance
        for column in COLUMNS
    ):
        return "Viscous friction alone fits badly, dry friction helps; nine averages prove neither"
    return "The nine averages cannot distinguish the models"


def conclusions(found: Calibration) -> list[str]:
    """What follows, and what does not."""
    return [
        *(_viscous(found, column) for column in COLUMNS),
        *(_dry(found, column) for column in COLUMNS),
        _aicc(found),
        _servo(found),
        _printed(found),
    ]


def _viscous(found: Calibration, column: Column) -> str:
    one = found.assessments[VISCOUS, column]
    worse = f"{one.bootstrap.as_bad} of {one.bootstrap.sets}" if one.bootstrap else "none"
    return (
        f"Viscous friction alone, {IF_MEASURED[column]}: deviance {one.student.deviance:.1f} by "
        f"Student's t; {worse} data sets that it generated itself fit it as badly. By the normal "
        "distribution, with standard errors taken as known, its chi-square is "
        f"{one.normal.deviance:.0f} on {one.aicc_normal.freedom} degrees of freedom."
    )


def _dry(found: Calibration, column: Column) -> str:
    small, large = found.assessments[VISCOUS, column], found.assessments[DRY, column]
    boot = large.bootstrap
    profiles = ", ".join(
        f"{UNKNOWNS[name].symbol} {span(UNKNOWNS[name], profile.ends(UNKNOWNS[name]))}"
        for name, profile in zip(large.model.profiled, large.profiles, strict=True)
    )
    return (
        f"With dry friction added, {IF_MEASURED[column]}: deviance {large.student.deviance:.1f}, "
        f"chi-square {large.normal.deviance:.0f} on {large.aicc_normal.freedom}. Rows left out are "
        f"predicted with a deviance of {large.left_out_deviance:.0f} instead of "
        f"{small.left_out_deviance:.0f}. Of data sets generated without dry friction "
        f"{f'{boot.gaining} of {boot.sets}' if boot else 'none'} gain as much from it. Profiles: "
        f"{profiles}."
    )


def _aicc(found: Calibration) -> str:
    of = found.assessments
    values = " and ".join(
        f"{aicc_text(of[VISCOUS, column].aicc)} against {aicc_text(of[DRY, column].aicc)} "
        f"{IF_MEASURED[column]}"
        for column in COLUMNS
    )
    small, large = (of[name, "mean"].aicc for name in (VISCOUS, DRY))
    return (
        f"AICc does not justify the sixth unknown: {values}. Of that its small-sample correction "
        f"alone is {small.correction:.0f} for five unknowns and {large.correction:.0f} for six, so "
        "with nine rows it says little. On the six rows of Table 3 alone it is undefined for five "
        "unknowns."
    )


def _servo(found: Calibration) -> str:
    def deviances(name: str) -> str:
        return " and ".join(f"{found.assessments[name, c].student.deviance:.1f}" for c in COLUMNS)

    return (
        "A servo limited to Table 1's 30 rpm does not improve the fit: deviances "
        f"{deviances('rate limit')} (first column, v_exp), with an exact servo "
        f"{deviances(VISCOUS)}. A lag leaves {deviances('lag')}. A limit would slow the fast "
        "gaits at T = 1 s most, and the measured speeds there are, if anything, too fast."
    )


def _printed(found: Calibration) -> str:
    gaps = [
        found.assessments["printed", column].student.deviance
        - found.assessments[VISCOUS, column].student.deviance
        for column in COLUMNS
    ]
    verb = "cannot" if all(abs(gap) < 6 for gap in gaps) else "do"
    return (
        f"The averages {verb} show that the signs of the printed equation (3) are wrong: its "
        f"deviance differs by {' and '.join(f'{gap:+.1f}' for gap in gaps)} from the corrected "
        "one's, and other values of the unknowns compensate. That it is wrong follows from "
        "mechanics, not from these rows."
    )


def valley(found: Calibration, column: Column) -> str:
    """What the rows determine instead of single values."""
    low, high = found.conditional(column, "a2", 0.0, 1e-3, "k")
    return (
        f"a2 and log k are coupled (correlation {found.correlation(column, 'a2', 'k'):.2f}): if a2 "
        f"were measured as 0 to within 1 mm, k would lie in {number(low, 2)} to "
        f"{number(high, 2)} N s/m."
    )


def shipped_text(found: Calibration, column: Column) -> str:
    """Whether the shipped robot's values lie inside, one by one and together."""
    values = shipped_values()
    outside = [
        one.unknown.symbol
        for one in found.intervals()
        if one.column == column
        and one.unknown.name in values
        and not one.contains(values[one.unknown.name])
    ]
    each = f"{', '.join(outside)} outside its interval" if outside else "each inside its interval"
    rises = [f"{found.shipped[column].rise:.1f} ({READINGS[0].words})"]
    rises += [
        f"{other.shipped.rise:.1f} ({other.reading.words})"
        for other in found.alternatives
        if other.column == column and other.shipped
    ]
    return (
        f"The shipped robot's a1, a2, b and k, {IF_MEASURED[column]}: {each}. Together they raise "
        f"the deviance by {', '.join(rises)}; with many data, {JOINT_LEVEL:.1f} would bound the "
        "joint 95 % region of four unknowns."
    )
