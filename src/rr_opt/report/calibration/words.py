"""What the nine rows allow to be said of the models, and no more."""

from __future__ import annotations

import numpy as np

from rr_opt.paper.calibration.calibrate import Calibration
from rr_opt.paper.calibration.compare import Charge
from rr_opt.paper.calibration.deviance import row_deviance
from rr_opt.paper.calibration.held import TABLE_3_ALONE, Held
from rr_opt.paper.calibration.intervals import ends_of
from rr_opt.paper.calibration.measured import COLUMNS, ROWS, Column
from rr_opt.paper.calibration.unknowns import UNKNOWNS
from rr_opt.report.calibration.span import span

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
