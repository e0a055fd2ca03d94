"""What is odd about single channels, whatever was to be recorded."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import Flag, Recording
from rr_opt.recordings.gaps import Gap, Jump
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.recordings.warnings import Notice, counted, notice, size_text

_KEYS = {
    "x": "noise.position",
    "y": "noise.position",
    "psi": "noise.angle",
    "phi": "noise.angle",
    "torque": "noise.torque",
}
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
    """Of the channels one by one, the jumps and the gaps.

    steps: in which the values of a channel come, in its unit; stated: sigma as the file has it.
    """
    usual = {channel: float(np.median(stated[channel])) for channel in recording.channels}
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
        "whose": "follow from the markers' residuals" if by_fit else "are stated",
        "remedy": "" if by_fit else f"Correct `{_KEYS[channel]}` if that is not intended.",
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
        return "Missing time, or a blow?"
    if channels <= {"x", "y", "psi"} and channels & {"x", "y"}:
        return (
            "Was the floor frame set anew, or has a marker another's name? Recordings share one "
            "floor frame: cut it there."
        )
    return "A marker with another's name, or a blow?"


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
