"""Units that are not what they should be, told from the size of the numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rr_opt.experiment.recording import Recording
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.time_step import time_step

_ROOM = 50.0
"""No floor on which a small robot is recorded is this long, m."""
_NO_ROOM = 1e5
"""Nor is one as long as this in mm."""
_TURN = 2 * np.pi
_SLOWEST = 0.5
"""Capture systems sample more often than every so many seconds."""
_LATEST = 1e6
"""Nor do they begin so many seconds, eleven days, after the command did."""


def unit_doubts(recording: Recording) -> tuple[Doubt, ...]:
    """What looks like another unit. Nothing is converted: the experimenter has to say."""
    return (*_of_time(recording), *_of_place(recording), *_of_angles(recording))


def _of_time(recording: Recording) -> Iterator[Doubt]:
    if len(recording) and abs(recording.t[0]) > _LATEST:
        yield Doubt(
            "units",
            f"The times begin at {recording.t[0]:.10g}, as those of a calendar do. Expected "
            "seconds since the command began; subtract the time at which it did.",
        )
        return
    step = time_step(recording.t)
    if step < _SLOWEST or len(recording) < 3:
        return
    if abs(step - 1) < 1e-6:
        what = "frame numbers: steps of 1. Expected seconds; divide by the frame rate."
    elif step < 1000 * _SLOWEST:
        what = f"milliseconds: steps of {step:.6g}. Expected seconds; divide by 1000."
    else:
        what = f"another unit than seconds: steps of {step:.6g}."
    yield Doubt("units", f"The times look like {what}")


def _of_place(recording: Recording) -> Iterator[Doubt]:
    ranges = [_range(recording.data(channel)) for channel in ("x", "y")]
    widest = max(ranges)
    if widest > _NO_ROOM:
        yield Doubt(
            "units",
            f"The positions range over {widest:.6g}, and no unit makes that a robot's motion. "
            "Expected metres.",
        )
    elif widest > _ROOM:
        yield Doubt(
            "units",
            f"The positions look like millimetres or centimetres: ranges of {_sizes(ranges)}. "
            "Expected metres; divide by 1000, or by 100.",
        )


def _of_angles(recording: Recording) -> Iterator[Doubt]:
    phi = np.abs(recording.data("phi"))
    largest = float(np.nanmax(phi)) if np.isfinite(phi).any() else 0.0
    if largest > 1000:
        yield Doubt(
            "units",
            f"phi reaches {largest:.6g}, and no unit makes that a servo's angle. Expected radians.",
        )
    elif largest > _TURN:
        yield Doubt(
            "units",
            f"The angles look like degrees: phi reaches {largest:.4g}. Expected radians; multiply "
            "by pi/180.",
        )


def _range(values: np.ndarray) -> float:
    return float(np.nanmax(values) - np.nanmin(values)) if np.isfinite(values).any() else 0.0


def _sizes(ranges: list[float]) -> str:
    return " and ".join(f"{size:.4g}" for size in ranges)
