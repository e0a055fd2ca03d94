"""The calibration in words, as text for a terminal, as a record and as tables."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np

from rr_opt.answers.quantities import number
from rr_opt.report.text import columns
from rr_opt.version import __version__
from rr_paper.calibration.calibrate import JOINT_LEVEL, Calibration, shipped_values
from rr_paper.calibration.compare import Charge
from rr_paper.calibration.held import TABLE_3_ALONE, Held
from rr_paper.calibration.intervals import Interval, correlation, ends_of, given, intervals
from rr_paper.calibration.models import (
    COLUMNS,
    MODELS,
    READINGS,
    ROWS,
    T_POINT,
    UNKNOWNS,
    Column,
    Unknown,
    row_deviance,
    values,
)
from rr_paper.calibration.profile import Profile


def span(unknown: Unknown, ends: tuple[float, float], digits: int = 2) -> str:
    """`-28 to 5 mm`; ends in SI."""
    low, high = (number(float(unknown.shown(end)), digits) for end in ends)
    return f"{low} to {high} {unknown.shown_unit}"


IF_MEASURED: dict[Column, str] = {
    "mean": "if the first column was measured",
    "other": "if v_exp was measured",
}


def charges(held: Held) -> dict[str, Charge]:
    """The fits of a model to all rows by each law, and to Table 3 alone."""
    count, rows = len(held.model.unknowns), len(ROWS)
    return {
        "student": Charge(rows, count, held.student.deviance),
        "normal": Charge(rows, count, held.normal.deviance),
        # Without Table 2 its amplitude is no unknown.
        "table3": Charge(int(TABLE_3_ALONE.sum()), count - 1, held.table3.deviance),
    }


def predicted(held: Held) -> float:
    """Deviance, by Student's law, of the nine rows each predicted from the other eight."""
    return float(row_deviance(held.left_out, "student").sum())


def aicc_text(charge: Charge) -> str:
    """The criterion to a tenth; `undefined` where there are too few rows."""
    return "undefined" if charge.aicc is None else f"{charge.aicc:.1f}"


def verdict(found: Calibration) -> str:
    """The comparison in a headline."""
    better = [
        predicted(found.held["viscous+dry", column]) < predicted(found.held["viscous", column])
        for column in COLUMNS
    ]
    if all(better):
        return "Viscous friction alone fits badly, dry friction helps; nine averages prove neither"
    return "The nine averages do not tell the models apart"


def conclusions(found: Calibration) -> list[str]:
    """Sentences, each with its numbers."""
    return [
        *(_alone(found, column) for column in COLUMNS),
        *(_dry(found, column) for column in COLUMNS),
        _aicc(found),
        _servo(found),
        _printed(found),
    ]


def _alone(found: Calibration, column: Column) -> str:
    held = found.held["viscous", column]
    made = held.likelier
    worse = f"{made.worse} of {made.sets}" if made else "none"
    return (
        f"Viscous friction alone, {IF_MEASURED[column]}: deviance {held.student.deviance:.1f} by "
        f"Student's law; {worse} data sets that it made itself fit it as badly. Read as normal, "
        f"with standard errors taken as known, its chi-square is {held.normal.deviance:.0f} on "
        f"{charges(held)['normal'].freedom} degrees of freedom."
    )


def _dry(found: Calibration, column: Column) -> str:
    small, large = found.held["viscous", column], found.held["viscous+dry", column]
    made = large.likelier
    gained = f"{made.gained} of {made.sets}" if made else "none"
    return (
        f"With dry friction too, {IF_MEASURED[column]}: deviance {large.student.deviance:.1f}, "
        f"chi-square {large.normal.deviance:.0f} on {charges(large)['normal'].freedom}. Rows left "
        f"out are predicted with a deviance of {predicted(large):.0f} instead of "
        f"{predicted(small):.0f}. Of data sets made without dry friction {gained} gain as much "
        f"from it. Profiles: {', '.join(_told(large))}."
    )


def _told(held: Held) -> list[str]:
    """`k 0.027 to 0.11 N s/m` for each unknown whose profile is told."""
    return [
        f"{UNKNOWNS[name].symbol} {span(UNKNOWNS[name], ends_of(UNKNOWNS[name], profile))}"
        for name, profile in zip(held.model.told, held.profiles, strict=True)
    ]


def _aicc(found: Calibration) -> str:
    parts = []
    for column in COLUMNS:
        small, large = (
            charges(found.held[name, column])["student"] for name in ("viscous", "viscous+dry")
        )
        parts.append(f"{aicc_text(small)} against {aicc_text(large)} {IF_MEASURED[column]}")
    corrections = [
        charges(found.held[name, "mean"])["student"].correction
        for name in ("viscous", "viscous+dry")
    ]
    return (
        f"AICc does not pay for the sixth unknown: {' and '.join(parts)}. Of that its small-sample "
        f"correction alone is {corrections[0]:.0f} for five unknowns and {corrections[1]:.0f} for "
        "six, so with nine rows it says little. On the six rows of Table 3 alone it is undefined "
        "for five unknowns."
    )


def _servo(found: Calibration) -> str:
    def deviances(name: str) -> str:
        return " and ".join(f"{found.held[name, c].student.deviance:.1f}" for c in COLUMNS)

    return (
        "A servo held to Table 1's 30 rpm makes the fit no better: deviances "
        f"{deviances('rate limit')} (first column, v_exp) where an exact servo has "
        f"{deviances('viscous')}. A lag leaves {deviances('lag')}. A limit would slow the fast "
        "gaits at T = 1 s most, and the measured speeds there are, if anything, too fast."
    )


def _printed(found: Calibration) -> str:
    gaps = [
        found.held["printed", column].student.deviance
        - found.held["viscous", column].student.deviance
        for column in COLUMNS
    ]
    alike = bool(np.all(np.abs(gaps) < 6))
    how = "The averages cannot show" if alike else "The averages do show"
    told = " and ".join(f"{gap:+.1f}" for gap in gaps)
    return (
        f"{how} that the signs of the printed equation (3) are wrong: it fits with a deviance "
        f"{told} from the corrected one's, other values of the unknowns making up for it. That it "
        "is wrong follows from mechanics, not from these rows."
    )


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


_WIDTH = 98


def summary(found: Calibration, files: Iterable[Path]) -> str:
    """The unknowns, the models, what follows, and the files."""
    blocks = [[verdict(found) + "."]]
    for column in COLUMNS:
        blocks.append([f"unknowns, viscous friction, {IF_MEASURED[column]}"])
        rows: list[tuple[str, ...]] = [("", "box", "95 % posterior", "95 % profile", "")]
        for one in intervals(found):
            if one.column == column:
                profile = profile_span(one, one.profile)
                rows.append(
                    (f"  {one.unknown.symbol}", box(one.unknown),
                     span(one.unknown, one.posterior), profile, one.word)
                )  # fmt: skip
        blocks[-1] += columns(rows)
        blocks[-1] += wrap(valley(found, column), _WIDTH)
    blocks.append(_models(found))
    for sentence in (*conclusions(found), *(shipped_text(found, column) for column in COLUMNS)):
        blocks.append(wrap(sentence, _WIDTH))
    blocks.append(columns([("files" if not i else "", str(file)) for i, file in enumerate(files)]))
    return "\n\n".join("\n".join(block) for block in blocks) + "\n"


def _models(found: Calibration) -> list[str]:
    rows: list[tuple[str, ...]] = [
        ("models", "measured", "unknowns", "deviance", "chi-square", "AICc", "rows left out")
    ]
    for (name, column), held in found.held.items():
        rows.append(
            (
                f"  {name}",
                "first" if column == "mean" else "v_exp",
                str(len(held.model.unknowns)),
                f"{held.student.deviance:.1f}",
                f"{held.normal.deviance:.1f}",
                aicc_text(charges(held)["student"]),
                f"{predicted(held):.0f}",
            )
        )
    return columns(rows)


def record(found: Calibration) -> dict[str, Any]:
    """The content of the file."""
    return {
        "verdict": verdict(found),
        "conclusions": conclusions(found),
        "t_of_the_intervals": T_POINT,
        "reading": READINGS[0].words,
        "unknowns": [
            {"name": one.name, "unit": one.unit, "box": [one.low, one.high],
             "flat_in": "logarithm" if one.log else "value", "why": one.why}
            for one in UNKNOWNS.values()
        ],
        "intervals": [
            {"unknown": one.unknown.name, "column": one.column, "posterior": list(one.posterior),
             "median": one.median, "profile_student": list(one.of(one.profile)),
             "profile_normal": list(one.of(one.normal)), "share_of_box": one.left,
             "verdict": one.word}
            for one in intervals(found)
        ],
        "models": [_model(found, name, column) for name in MODELS for column in COLUMNS],
        "posterior": {
            column: {"draws": len(one.points), "split_rhat": one.rhat,
                     "library_effective_points": one.library_weight}
            for column, one in found.posterior.items()
        },
        "shipped": {
            column: {"values": one.values, "rise": one.rise, "amplitude": one.amplitude}
            for column, one in found.shipped.items()
        },
        "coverage": {
            "sets": found.coverage.sets,
            "unknowns": list(MODELS["viscous"].unknowns),
            "posterior": found.coverage.posterior.tolist(),
            "profile_student": found.coverage.profile["student"].tolist(),
            "profile_normal": found.coverage.profile["normal"].tolist(),
            "rise_needed": found.coverage.needed.tolist(),
        },
        "readings": [
            {"reading": one.reading.words, "model": one.model.name, "column": one.column,
             "deviance": one.student.deviance,
             "shipped_rise": one.shipped.rise if one.shipped else None}
            for one in found.alternatives
        ],
        "version": __version__,
    }  # fmt: skip


def _model(found: Calibration, name: str, column: Any) -> dict[str, Any]:
    held = found.held[name, column]
    of, made = charges(held), held.likelier
    best = values(held.model.unknowns, held.student.point[None])
    return {
        "model": name,
        "column": column,
        "words": held.model.words,
        "best": {unknown: float(value[0]) for unknown, value in best.items()},
        "deviance": held.student.deviance,
        "chi_square": held.normal.deviance,
        "degrees_of_freedom": of["student"].freedom,
        "aicc": of["student"].aicc,
        "aicc_normal": of["normal"].aicc,
        "table3_deviance": held.table3.deviance,
        "table3_aicc": of["table3"].aicc,
        "left_out_deviance": predicted(held),
        "profiles": {
            unknown: list(ends_of(UNKNOWNS[unknown], profile))
            for unknown, profile in zip(held.model.told, held.profiles, strict=True)
        },
        "made": {"sets": made.sets, "as_bad": made.worse, "gaining_as_much": made.gained}
        if made
        else None,
    }
