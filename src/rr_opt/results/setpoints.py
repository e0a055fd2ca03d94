"""A gait as set points for a controller, their file, and the speed they lose."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.archive import file_for_result, write_text
from rr_opt.formatting import QUANTITIES, number, speed_text, with_unit
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.motion.setpoints import CENTRE, COUNT, Cost, SetPoints, interpolated, lag
from rr_opt.results.gait import gait_facts
from rr_opt.results.motion import GaitResult
from rr_opt.results.result import Progress, quiet
from rr_opt.version import __version__

Format = Literal["csv", "c-header", "servo"]

ENDINGS: dict[Format, str] = {"csv": "-angles.csv", "c-header": ".h", "servo": "-counts.csv"}
"""Endings of the file name, unless the user gives a name."""


@dataclass(frozen=True, repr=False)
class ExportedGait(GaitResult):
    """A gait as set points: `points` has them as arrays, `cost` what they lose in speed."""

    points: SetPoints
    cost: Cost
    format: Format

    @property
    def text(self) -> str:
        """The content of the file for the controller."""
        return text_of(self.points, self.format)

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence if the servo is too slow for the steps between set points."""
        angles = self.points.rounded if self.format == "servo" else self.points.angles
        needed = interpolated(angles, self.points.rate).peak_rate
        limit, both = self.robot.servo.rate_limit, QUANTITIES["rate"].both
        if needed <= limit * (1 + LARGEST_EXCESS):
            return ()
        behind = lag(angles, self.points.rate, limit)
        return (
            f"A step between set points needs {both(needed)}, but the servo's rate limit is "
            f"{both(limit)}: the servo lags by up to {number(1e3 * behind)} mrad. The cost in "
            "speed ignores this.",
        )

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Rate, period, the speed lost (negative) or gained by each step, SI, and the file."""
        return super().record() | {"file": str(files[0]) if files else None}

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the file for the controller."""
        return [write_text(file_for_result(Path(path)), self.text)]

    def _record(self) -> dict[str, Any]:
        """Rate, period, and the speed lost (negative) or gained by each step, SI."""
        points, cost = self.points, self.cost
        return {
            "gait": points.gait,
            "status": self.source_status,
            "format": self.format,
            "rate": points.rate,
            "points": len(points.angles),
            "period": points.played.period,
            "amplitude": points.played.amplitude,
            "speed": cost.nominal,
            "speed_left": cost.final,
            "cost": {"period": 0.0, "holding": 0.0, "rounding": None, **cost.steps},
            "model": MODEL,
            "file": None,
            "version": __version__,
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The set points and their cost, for a terminal."""
        return doc.facts_alone(_facts(self), MODEL)


def text_of(points: SetPoints, format: Format) -> str:
    """The content of the file: a row for each set point, t (s) with phi (rad), phi_deg (degrees) or
    the count (512 is phi = 0); or a C array.

    Raises InputError for an angle beyond the servo's counts.
    """
    t, phi = np.arange(len(points.angles)) / points.rate, points.angles
    if format == "csv":
        return doc.csv_columns(("t [s]", "phi [rad]", "phi [deg]"), (t, phi, np.degrees(phi)))
    if format == "servo":
        return doc.csv_columns(("t [s]", "count"), (t, points.counts))
    return _c_header(points)


_PER_LINE = 6


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
    """A C float literal; a value rounded to zero has no sign."""
    text = f"{0.0 if math.isclose(value, 0.0, abs_tol=1e-12) else value:.9g}"
    return (text if any(mark in text for mark in ".e") else f"{text}.0") + "f"


MODEL = (
    "The servo is assumed to move at constant speed between set points and to reach each one when "
    "the next is sent. Its effects in `physics`, such as a lag, then act on that motion."
)

_NOTHING = 1e-6
"""A smaller relative change is the optimiser's rounding."""

_STEPS = {
    "period": "by the changed period and amplitude",
    "holding": "by moving in straight lines between set points",
    "rounding": f"by rounding to counts of {1e3 * COUNT:.2f} mrad",
}


def _facts(result: ExportedGait) -> Iterator[doc.Fact]:
    points, cost = result.points, result.cost
    rate = f"{with_unit(points.rate, '', 6)} a second, one every {number(1e3 / points.rate)} ms"
    yield from gait_facts(points.gait)
    yield doc.Fact("set points", f"{len(points.angles)} a period, {rate}")
    yield doc.Fact("  period", _period_text(points))
    asked, sent = points.gait.amplitude, points.played.amplitude
    if not math.isclose(asked, sent, rel_tol=_NOTHING):
        change = f"lowered from {with_unit(asked, 'rad', 6)} ({100 * (sent / asked - 1):+.2f} %)"
        yield doc.Fact(
            "  amplitude", f"{with_unit(sent, 'rad', 6)}, {change} to stay within the limits"
        )
    yield doc.Fact("speed", f"{speed_text(cost.nominal)}, of the gait itself")
    for name, change in cost.steps.items():
        yield doc.Fact(f"  {name}", f"{_change_text(change, cost.nominal)} {_STEPS[name]}")
    total = _change_text(sum(cost.steps.values()), cost.nominal)
    yield doc.Fact("  left", f"{speed_text(cost.final)}, {total}")


def _period_text(points: SetPoints) -> str:
    asked, played = points.gait.period, points.played.period
    if math.isclose(asked, played, rel_tol=_NOTHING):
        return f"{with_unit(asked, 's')}, as asked"
    return (
        f"{with_unit(played, 's', 6)}, changed from {with_unit(asked, 's', 6)} "
        f"({100 * (played / asked - 1):+.2f} %), a whole number of set points"
    )


def _change_text(change: float, nominal: float) -> str:
    """`-0.36 mm/s (-0.28 %)`: a change of a speed."""
    if abs(change) <= _NOTHING * abs(nominal):
        return "0 mm/s"
    share = f" ({100 * change / abs(nominal):+.2f} %)" if nominal else ""
    return f"{'+' if change > 0 else ''}{number(1e3 * change, 3)} mm/s{share}"
