"""Set points as a file: CSV, a C header, or the counts of the servo CDS5516."""

from __future__ import annotations

import io
import math
from typing import Literal

import numpy as np

from rr_opt import __version__
from rr_opt.report.setpoints.setpoints import CENTRE, SetPoints

Format = Literal["csv", "c-header", "servo"]

ENDINGS: dict[Format, str] = {"csv": "-angles.csv", "c-header": ".h", "servo": "-counts.csv"}
"""What the name of a file ends with, unless the user gives another name."""

_PER_LINE = 6


def text_of(points: SetPoints, kind: Format) -> str:
    """The content of the file. Raises InputError for an angle beyond the servo's counts."""
    return {"csv": _csv, "c-header": _c_header, "servo": _counts}[kind](points)


def _csv(points: SetPoints) -> str:
    """A row a set point: t (s), phi (rad), phi_deg (degrees)."""
    return _table(points, "t,phi,phi_deg", [points.angles, np.degrees(points.angles)], "%.9g")


def _counts(points: SetPoints) -> str:
    """A row a set point: t (s) and the count, 512 where phi is 0."""
    return _table(points, "t,count", [points.counts], "%d")


def _table(points: SetPoints, header: str, columns: list[np.ndarray], form: str) -> str:
    t = np.arange(len(points.angles)) / points.rate
    text = io.StringIO()
    np.savetxt(
        text,
        np.column_stack([t, *columns]),
        fmt=["%.9g", *[form] * len(columns)],
        delimiter=",",
        header=header,
        comments="",
    )
    return text.getvalue()


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
