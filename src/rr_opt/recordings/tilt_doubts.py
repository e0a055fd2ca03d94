"""Platforms that lean out of the floor, in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from rr_opt.recordings.doubts import Doubt, frames_text, when
from rr_opt.recordings.markers_file import MarkerData

if TYPE_CHECKING:
    from rr_opt.recordings.from_markers import MarkerFit

_TILTS = 6.0
"""Times the typical tilt from which on a frame's is told."""


def tilt_doubts(data: MarkerData, made: MarkerFit) -> Iterator[Doubt]:
    """Of frames in which a platform leans more than it usually does."""
    for one in (0, 1):
        lean = made.tilt[:, one]
        known = np.isfinite(lean)
        if known.sum() < 20:
            continue
        usual = float(np.median(lean[known]))
        rows = np.flatnonzero(known & (lean > max(_TILTS * usual, 0.01)))
        if len(rows):
            yield Doubt(
                "tilt",
                f"Platform {one + 1} leans by up to {np.degrees(np.nanmax(lean)):.1f} deg in "
                f"{frames_text(len(rows))} {when(data.t, rows)}, against "
                f"{np.degrees(usual):.2g} deg usually: a wheel off the floor, or a bump?",
            )
