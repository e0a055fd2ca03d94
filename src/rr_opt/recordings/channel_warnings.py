"""What is odd about single channels and about the motion, in sentences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import Flag, Recording
from rr_opt.recordings.gaps import Gap, Jump, jump_doubts
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.recordings.time_axis import time_step
from rr_opt.recordings.warnings import Doubt, size_text

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


_MANY, _FEW = 1.25, 0.8
"""Times the stated noise from which on the estimate contradicts it."""
_COLOURED, _ALTERNATING, _CHANCE = 1.2, 0.85, 1e-4
_LONG = 0.1
"""Gaps longer than this are told one by one, s."""
_LISTED = 3


def turn_doubts(turns: Mapping[str, int]) -> tuple[Doubt, ...]:
    """Of angles that jumped by turns and were unwrapped."""
    return tuple(
        Doubt("turns", f"{angle} jumps by a whole turn {count} times. It was unwrapped.")
        for angle, count in turns.items()
        if count
    )


def step_doubts(steps: Mapping[str, float], stated: Mapping[str, Array]) -> tuple[Doubt, ...]:
    """Of channels whose values are rounded to steps larger than their noise."""
    return tuple(
        Doubt(
            "steps",
            f"{channel} comes in steps of {size_text(channel, step)}, larger than its noise: it "
            "was rounded. Its errors are then not independent; export more digits.",
        )
        for channel, step in steps.items()
        if step > np.nan_to_num(float(np.median(stated[channel])))
    )


def channel_doubts(
    recording: Recording,
    noise: Mapping[str, NoiseEstimate],
    holes: Sequence[Gap],
    found: Mapping[str, Sequence[Jump]],
    stated: Mapping[str, Array],
) -> tuple[Doubt, ...]:
    """All of them, channel by channel, then the gaps."""
    doubts: list[Doubt] = []
    by_fit = "motion" in recording.source
    for channel in recording.channels:
        if not np.isfinite(recording.data(channel)).any():
            continue
        doubts += _of_noise(channel, noise[channel], stated[channel], by_fit=by_fit)
        doubts += _of_outliers(recording, channel)
    return (*doubts, *jump_doubts(recording, found), *_of_gaps(holes))


def _of_noise(
    channel: str, noise: NoiseEstimate, stated: Array, *, by_fit: bool
) -> Iterator[Doubt]:
    """by_fit: what is stated follows from the markers' noise."""
    if not np.isfinite(noise.sigma):
        yield Doubt("noise", f"{channel} has too few samples in a row to tell its noise.")
        return
    if noise.sigma == 0:
        yield Doubt("noise", f"{channel} has no noise at all: is it computed, or constant?")
        return
    said = float(np.median(stated))
    times = noise.times(said)
    whose = "the markers' residuals lead to" if by_fit else "are stated"
    coloured = noise.p_white < _CHANCE and noise.colour > _COLOURED
    if times > _MANY:
        yield Doubt(
            "noise",
            f"The noise of {channel} is {size_text(channel, noise.sigma)}, and "
            f"{size_text(channel, said)} {whose}.",
        )
    if times < _FEW:
        better = "Markers that slip or bend?" if by_fit else "A better capture than stated?"
        why = "A filter upstream?" if coloured else better
        yield Doubt(
            "noise",
            f"The noise of {channel} at the highest frequencies is "
            f"{size_text(channel, noise.sigma)}, less than the {size_text(channel, said)} that "
            f"{whose}. {why}",
        )
    if coloured:
        yield Doubt(
            "colour",
            f"The noise of {channel} is not white: at half the frequency it is "
            f"{noise.colour:.3g} times as large. A filter upstream, or so little noise that the "
            "motion itself shows; samples are then not independent.",
        )
    elif noise.p_white < _CHANCE and noise.colour < _ALTERNATING:
        yield Doubt(
            "colour",
            f"The noise of {channel} is not white: at half the frequency it is only "
            f"{noise.colour:.2g} times as large. Two cameras in turn, or time stamps that jitter?",
        )


def _of_outliers(recording: Recording, channel: str) -> Iterator[Doubt]:
    rows = np.flatnonzero(recording.flags[channel] & Flag.OUTLIER)
    if not len(rows):
        return
    share = 100 * len(rows) / len(recording)
    listed = ", ".join(f"{recording.t[row]:.6g}" for row in rows[:_LISTED])
    more = ", ..." if len(rows) > _LISTED else ""
    yield Doubt(
        "outlier",
        f"{channel} has {len(rows)} outlier{'s' if len(rows) > 1 else ''} ({share:.2g} % of its "
        f"samples), at t = {listed}{more} s. Flagged, not removed.",
    )


def _of_gaps(holes: Sequence[Gap]) -> Iterator[Doubt]:
    long = [gap for gap in holes if gap.length > _LONG and gap.channels]
    short = [gap for gap in holes if gap.length <= _LONG and gap.channels]
    for gap in sorted(long, key=lambda one: -one.length)[:_LISTED]:
        yield Doubt(
            "gap",
            f"{', '.join(gap.channels)}: no data for {gap.length:.3g} s after t = {gap.start:.6g} "
            "s. The gap is not filled.",
        )
    if len(long) > _LISTED:
        total = sum(gap.length for gap in long)
        yield Doubt("gap", f"{len(long)} gaps in all are longer than {_LONG} s, {total:.3g} s.")
    if short:
        lost = sum(gap.samples for gap in short)
        yield Doubt(
            "gap",
            f"{len(short)} short gap{'s' if len(short) > 1 else ''} of up to "
            f"{1e3 * max(gap.length for gap in short):.0f} ms, {lost} samples: bridged in figures, "
            "not in the data.",
        )


_HARDLY = 0.02
"""A path shorter than this tells little about friction, m."""
_MOTION_DOUBTS_FEW = 10
_STILL = 6.0
"""A range, of 98 % of the samples, within so many standard deviations is noise; Gaussian noise has
4.7."""


def motion_doubts(
    recording: Recording, noise: Mapping[str, NoiseEstimate], stated: Mapping[str, Array]
) -> tuple[Doubt, ...]:
    """What is odd about the motion as a whole."""
    return (*_of_angle(recording, noise, stated), *_of_path(recording))


def _of_angle(
    recording: Recording, noise: Mapping[str, NoiseEstimate], stated: Mapping[str, Array]
) -> Iterator[Doubt]:
    phi = recording.data("phi")
    phi = phi[np.isfinite(phi)]
    if len(phi) < _MOTION_DOUBTS_FEW:
        yield Doubt("motion", f"phi has {_few(len(phi), recording)}.")
        return
    sigma = np.nan_to_num([noise["phi"].sigma, float(np.median(stated["phi"]))]).max()
    low, high = np.percentile(phi, (1, 99))
    if high - low <= _STILL * sigma:
        yield Doubt(
            "motion",
            f"phi does not move: it stays within {high - low:.2g} rad. Expected a wiggle of the "
            "servo.",
        )


def _of_path(recording: Recording) -> Iterator[Doubt]:
    x, y = recording.data("x"), recording.data("y")
    both = np.isfinite(x) & np.isfinite(y)
    if both.sum() < _MOTION_DOUBTS_FEW:
        yield Doubt("motion", f"The joint's place has {_few(int(both.sum()), recording)}.")
        return
    x, y = x[both], y[both]
    far = float(np.hypot(x - x[0], y - y[0]).max())
    if far < _HARDLY:
        yield Doubt(
            "motion",
            f"This robot hardly moves: the joint never is more than {1e3 * far:.2g} mm from where "
            "it began. Such a recording says little about friction or inertia.",
        )


def _few(count: int, recording: Recording) -> str:
    return (
        f"{count} samples that are taken as data, of {len(recording)}"
        if count
        else "no data at all"
    )
