"""Set points as a file, and in some lines of text."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.motion import Format, SetPointsAnswer
from rr_opt.answers.quantities import number, speed_text, with_unit
from rr_opt.files.gait_record import gait_record
from rr_opt.motion.setpoints import CENTRE, COUNT, Cost, SetPoints
from rr_opt.report.document import Fact, csv_text
from rr_opt.report.gait import gait_facts
from rr_opt.report.text import facts_text
from rr_opt.version import __version__

ENDINGS: dict[Format, str] = {"csv": "-angles.csv", "c-header": ".h", "servo": "-counts.csv"}
"""What the name of a file ends with, unless the user gives another name."""

_PER_LINE = 6


def text_of(points: SetPoints, kind: Format) -> str:
    """The content of the file. Raises InputError for an angle beyond the servo's counts."""
    return {"csv": _csv, "c-header": _c_header, "servo": _counts}[kind](points)


def _csv(points: SetPoints) -> str:
    """A row a set point: t (s), phi (rad), phi_deg (degrees)."""
    rows = zip(
        _times(points), points.angles.tolist(), np.degrees(points.angles).tolist(), strict=True
    )
    return csv_text(("t", "phi", "phi_deg"), rows)


def _counts(points: SetPoints) -> str:
    """A row a set point: t (s) and the count, 512 where phi is 0."""
    return csv_text(("t", "count"), zip(_times(points), points.counts.tolist(), strict=True))


def _times(points: SetPoints) -> list[float]:
    return (np.arange(len(points.angles)) / points.rate).tolist()


def _c_header(points: SetPoints) -> str:
    numbers = [_c_float(angle) for angle in points.angles]
    rows = [numbers[i : i + _PER_LINE] for i in range(0, len(numbers), _PER_LINE)]
    array = ",\n".join("    " + ", ".join(row) for row in rows)
    return f"""\
/* Set points of a Roller Racer gait, written by rr-opt {__version__}.
 *
 * Send rr_gait_angle[i % RR_GAIT_POINTS] at t = i/RR_GAIT_RATE. The angle is phi, from platform
 * 1 to platform 2, in rad. As CDS5516 counts: {CENTRE} + phi * 1024 * 180/(300 * pi).
 */
#ifndef RR_GAIT_H
#define RR_GAIT_H

#define RR_GAIT_POINTS {len(numbers)} /* set points in a period */
#define RR_GAIT_RATE {_c_float(points.rate)} /* set points a second */
#define RR_GAIT_PERIOD {_c_float(points.played.period)} /* s */

static const float rr_gait_angle[RR_GAIT_POINTS] = {{
{array}
}};

#endif
"""


def _c_float(value: float) -> str:
    """A float literal of C; rounding to nothing has no sign."""
    text = f"{0.0 if math.isclose(value, 0.0, abs_tol=1e-12) else value:.9g}"
    return (text if any(mark in text for mark in ".e") else f"{text}.0") + "f"


MODEL = (
    "Between set points the servo is taken to move at constant speed, and to be at each when the "
    "next one is sent. Its lag is not counted."
)

_NOTHING = 1e-6
"""A change so small, relative, is that of an optimiser's last digits."""

_WORDS = {
    "period": "by the changed period",
    "holding": "by moving straight from one set point to the next",
    "rounding": f"by rounding to counts of {1e3 * COUNT:.2f} mrad",
}


def setpoints_summary(answer: SetPointsAnswer, file: Path | None) -> str:
    """The gait, its set points, the speed before and after, and the file."""
    points, cost = answer.points, answer.cost
    text = facts_text(
        *gait_facts(points.gait),
        Fact("set points", f"{len(points.angles)} a period, {_rate_text(points)}"),
        Fact("  period", _period_text(points)),
        Fact("speed", f"{speed_text(cost.nominal)}, of the gait itself"),
        *(Fact(f"  {name}", f"{_change(cost, name)} {_WORDS[name]}") for name in cost.steps),
        Fact("  left", f"{speed_text(cost.final)}, {_change(cost)}"),
        *((Fact("file", str(file)),) if file else ()),
    )
    return f"{text}\n{MODEL}\n"


def setpoints_record(answer: SetPointsAnswer, file: Path | None) -> dict[str, Any]:
    """The same for scripts, SI; `cost` is the speed lost (negative) or gained by each step."""
    points, cost = answer.points, answer.cost
    return {
        "gait": gait_record(points.gait),
        "status": answer.source_status,
        "format": answer.format,
        "rate": points.rate,
        "points": len(points.angles),
        "period": points.played.period,
        "speed": cost.nominal,
        "speed_left": cost.final,
        "cost": {"period": 0.0, "holding": 0.0, "rounding": None, **cost.steps},
        "model": MODEL,
        "file": str(file) if file else None,
        "version": __version__,
    }


def _rate_text(points: SetPoints) -> str:
    return f"{with_unit(points.rate, '', 6)} a second, one every {number(1e3 / points.rate)} ms"


def _period_text(points: SetPoints) -> str:
    asked, played = points.gait.period, points.played.period
    if math.isclose(asked, played, rel_tol=_NOTHING):
        return f"{with_unit(asked, 's')}, as asked"
    return (
        f"{with_unit(played, 's', 6)}, changed from {with_unit(asked, 's', 6)} "
        f"({100 * (played / asked - 1):+.2f} %), a whole number of set points"
    )


def _change(cost: Cost, name: str | None = None) -> str:
    """`-0.36 mm/s (-0.28 %)`: of one step, or of all together."""
    change = cost.steps[name] if name else sum(cost.steps.values())
    if abs(change) <= _NOTHING * abs(cost.nominal):
        return "0 mm/s"
    share = f" ({100 * change / abs(cost.nominal):+.2f} %)" if cost.nominal else ""
    return f"{'+' if change > 0 else ''}{number(1e3 * change, 3)} mm/s{share}"
