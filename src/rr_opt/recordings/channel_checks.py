"""What is odd about single channels and about the motion, whatever was to be recorded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import Flag, Recording
from rr_opt.recordings.gaps import Gap, Jump
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.recordings.time_axis import time_step
from rr_opt.recordings.warnings import Notice, counted, notice, size_text

_ROOM, _NO_ROOM = 50.0, 1e5
"""No floor on which a small robot is recorded is as long in m, nor in mm."""
_NO_ANGLE = 1000.0
"""No servo turns so far in rad, nor in degrees."""
_SLOWEST = 0.5
"""Capture systems sample more often than every so many seconds."""
_LATEST = 1e6
"""Nor do they begin so many seconds, eleven days, after the command did."""


def unit_notices(recording: Recording) -> tuple[Notice, ...]:
    """What looks like another unit. Nothing is converted: the experimenter has to say."""
    return (*_of_time(recording), *_of_place(recording), *_of_angles(recording))


def _of_time(recording: Recording) -> Iterator[Notice]:
    if len(recording) and abs(recording.t[0]) > _LATEST:
        yield notice("units.calendar", start=recording.t[0])
        return
    step = time_step(recording.t)
    if step < _SLOWEST or len(recording) < 3:
        return
    if abs(step - 1) < 1e-6:
        yield notice("units.frames")
    else:
        yield notice("units.milliseconds" if step < 1000 * _SLOWEST else "units.time", step=step)


def _of_place(recording: Recording) -> Iterator[Notice]:
    ranges = [_range(recording.data(channel)) for channel in ("x", "y")]
    if max(ranges) > _NO_ROOM:
        yield notice("units.place", widest=max(ranges))
    elif max(ranges) > _ROOM:
        yield notice("units.millimetres", ranges=" and ".join(f"{size:.4g}" for size in ranges))


def _of_angles(recording: Recording) -> Iterator[Notice]:
    phi = np.abs(recording.data("phi"))
    largest = float(np.nanmax(phi)) if np.isfinite(phi).any() else 0.0
    if largest > 2 * np.pi:
        yield notice("units.angle" if largest > _NO_ANGLE else "units.degrees", largest=largest)


def _range(values: Array) -> float:
    return float(np.nanmax(values) - np.nanmin(values)) if np.isfinite(values).any() else 0.0


_MANY, _FEW = 1.25, 0.8
"""Times the stated noise from which on the estimate contradicts it."""
_COLOURED, _ALTERNATING, _CHANCE = 1.2, 0.85, 1e-4
_LONG = 0.1
"""Gaps longer than this are told one by one, s."""
_LISTED = 3


def channel_notices(
    recording: Recording,
    noise: Mapping[str, NoiseEstimate],
    steps: Mapping[str, float],
    holes: Sequence[Gap],
    found: Mapping[str, Sequence[Jump]],
    stated: Mapping[str, Array],
) -> Iterator[Notice]:
    """Of the motion, the channels one by one, the jumps and the gaps.

    steps: in which the values of a channel come, in its unit; stated: sigma as the file has it.
    """
    usual = {channel: float(np.median(stated[channel])) for channel in recording.channels}
    yield from _of_servo(recording, noise["phi"], usual["phi"])
    yield from _of_path(recording)
    for channel, step in steps.items():
        if step > np.nan_to_num(usual[channel]):
            yield notice("steps.channel", channel=channel, step=size_text(channel, step))
    by_fit = "motion" in recording.source
    for channel in recording.channels:
        if np.isfinite(recording.data(channel)).any():
            yield from _of_noise(channel, noise[channel], usual[channel], by_fit=by_fit)
            yield from _of_outliers(recording, channel)
    yield from _of_jumps(recording, found)
    yield from _of_gaps(holes)


def _of_noise(
    channel: str, noise: NoiseEstimate, stated: float, *, by_fit: bool
) -> Iterator[Notice]:
    """by_fit: what is stated follows from the markers' noise."""
    if not noise.sigma > 0:
        yield notice("noise.zero" if noise.sigma == 0 else "noise.few", channel=channel)
        return
    times = noise.times(stated)
    surely = noise.p_white < _CHANCE
    coloured = surely and noise.colour > _COLOURED
    sizes = {
        "channel": channel,
        "noise": size_text(channel, noise.sigma),
        "stated": size_text(channel, stated),
        "whose": "the markers' residuals lead to" if by_fit else "are stated",
    }
    if times > _MANY:
        yield notice("noise.large", **sizes)
    if times < _FEW:
        better = "Markers that slip or bend?" if by_fit else "A better capture than stated?"
        yield notice("noise.small", **sizes, why="A filter upstream?" if coloured else better)
    if coloured:
        yield notice("colour.filtered", channel=channel, colour=noise.colour)
    elif surely and noise.colour < _ALTERNATING:
        yield notice("colour.alternating", channel=channel, colour=noise.colour)


def _of_outliers(recording: Recording, channel: str) -> Iterator[Notice]:
    rows = np.flatnonzero(recording.flags[channel] & Flag.OUTLIER)
    if len(rows):
        listed = ", ".join(f"{recording.t[row]:.6g}" for row in rows[:_LISTED])
        yield notice(
            "outlier.channel",
            channel=channel,
            count=counted(len(rows), "outlier"),
            share=100 * len(rows) / len(recording),
            listed=listed + (", ..." if len(rows) > _LISTED else ""),
        )


_TOGETHER = 2
"""Rows within which jumps are one event."""


def _of_jumps(recording: Recording, found: Mapping[str, Sequence[Jump]]) -> Iterator[Notice]:
    """One for each instant at which channels jump, the first ones."""
    events: list[tuple[int, dict[str, float]]] = []
    every = sorted((jump.row, channel, jump.size) for channel in found for jump in found[channel])
    for row, channel, size in every:
        if events and row - events[-1][0] <= _TOGETHER and channel not in events[-1][1]:
            events[-1][1][channel] = size
        else:
            events.append((row, {channel: size}))
    for row, sizes in events[:_LISTED]:
        listed = ", ".join(f"{name} by {size_text(name, size)}" for name, size in sizes.items())
        yield notice("jump.channels", t=recording.t[row], listed=listed, why=_why(set(sizes)))
    if len(events) > _LISTED:
        yield notice("jump.more", count=len(events) - _LISTED)


def _why(channels: set[str]) -> str:
    if "phi" in channels and len(channels) > 1:
        return "time that is missing, or a blow?"
    if channels <= {"x", "y", "psi"} and channels & {"x", "y"}:
        return (
            "the floor frame was set anew, or a marker has another's name? Recordings share one "
            "floor frame: cut it there."
        )
    return "a marker with another's name, or a blow?"


def _of_gaps(holes: Sequence[Gap]) -> Iterator[Notice]:
    holes = [gap for gap in holes if gap.channels]
    long = [gap for gap in holes if gap.length > _LONG]
    short = [gap for gap in holes if gap.length <= _LONG]
    for gap in sorted(long, key=lambda one: -one.length)[:_LISTED]:
        names = ", ".join(gap.channels)
        yield notice("gap.long", channels=names, length=gap.length, start=gap.start)
    if len(long) > _LISTED:
        total = sum(gap.length for gap in long)
        yield notice("gap.many", count=len(long), most=_LONG, total=total)
    if short:
        yield notice(
            "gap.short",
            count=counted(len(short), "short gap"),
            longest=1e3 * max(gap.length for gap in short),
            lost=sum(gap.samples for gap in short),
        )


_HARDLY = 0.02
"""A path shorter than this tells little about friction, m."""
_SAMPLES = 10
_STILL = 6.0
"""A range, of 98 % of the samples, within so many standard deviations is noise; Gaussian noise has
4.7."""


def _of_servo(recording: Recording, noise: NoiseEstimate, stated: float) -> Iterator[Notice]:
    phi = recording.data("phi")
    phi = phi[np.isfinite(phi)]
    if len(phi) < _SAMPLES:
        yield notice("motion.few", what="phi", count=_samples(len(phi), recording))
        return
    sigma = np.nan_to_num([noise.sigma, stated]).max()
    low, high = np.percentile(phi, (1, 99))
    if high - low <= _STILL * sigma:
        yield notice("motion.servo", range=high - low)


def _of_path(recording: Recording) -> Iterator[Notice]:
    x, y = recording.data("x"), recording.data("y")
    both = np.isfinite(x) & np.isfinite(y)
    count = int(both.sum())
    if count < _SAMPLES:
        yield notice("motion.few", what="The joint's place", count=_samples(count, recording))
        return
    x, y = x[both], y[both]
    far = float(np.hypot(x - x[0], y - y[0]).max())
    if far < _HARDLY:
        yield notice("motion.robot", far=1e3 * far)


def _samples(count: int, recording: Recording) -> str:
    if not count:
        return "no data at all"
    return f"{count} samples that are taken as data, of {len(recording)}"
