"""A gait as set points for a controller, and their file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from rr_opt.documents.archive import file_for_result, write_text
from rr_opt.documents.document import csv_text
from rr_opt.documents.report import Progress, quiet
from rr_opt.formatting import QUANTITIES
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.motion.setpoints import CENTRE, Cost, SetPoints, interpolated
from rr_opt.results.motion import GaitResult
from rr_opt.version import __version__

Format = Literal["csv", "c-header", "servo"]

ENDINGS: dict[Format, str] = {"csv": "-angles.csv", "c-header": ".h", "servo": "-counts.csv"}
"""What the name of a file ends with, unless the user gives another name."""


@dataclass(frozen=True, repr=False)
class ExportedGait(GaitResult):
    """A gait as set points: `points` has them as arrays, `cost` what they lose in speed."""

    REPORT = "rr_opt.report.setpoints"

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
        return (
            f"A step between set points needs {both(needed)}, but the servo's rate limit is "
            f"{both(limit)}. The cost in speed ignores this limit.",
        )

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Rate, period, the speed lost (negative) or gained by each step, SI, and the file."""
        return super().record() | {"file": str(files[0]) if files else None}

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the file for the controller."""
        return [write_text(file_for_result(Path(path)), self.text)]


def text_of(points: SetPoints, format: Format) -> str:
    """The content of the file: a row for each set point, t (s) with phi (rad), phi_deg (degrees) or
    the count, 512 where phi is 0; or an array for C.

    Raises InputError for an angle beyond the servo's counts.
    """
    times = (np.arange(len(points.angles)) / points.rate).tolist()
    if format == "csv":
        angles = points.angles.tolist(), np.degrees(points.angles).tolist()
        return csv_text(("t", "phi", "phi_deg"), zip(times, *angles, strict=True))
    if format == "servo":
        return csv_text(("t", "count"), zip(times, points.counts.tolist(), strict=True))
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
    """A float literal of C; rounding to nothing has no sign."""
    text = f"{0.0 if math.isclose(value, 0.0, abs_tol=1e-12) else value:.9g}"
    return (text if any(mark in text for mark in ".e") else f"{text}.0") + "f"
