"""A recording cleaned: angles unwrapped, outliers flagged, noise measured, every oddity reported.

Nothing is filled in, nothing is smoothed and no value is changed but for whole turns of an angle.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.formatting import counted
from rr_opt.model.experiment import Flag, Recording
from rr_opt.recordings.gaps import Gap, Jump, gaps, jumps, without_inventions
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.recordings.nuisances.plausible import unit_notices
from rr_opt.recordings.outliers import outliers, step_of, usual_noise
from rr_opt.recordings.time_axis import LACKING, time_step
from rr_opt.recordings.warnings import Notice, notice, size_text


def unwrapped(angle: Array) -> Array:
    """The angle (n,), rad, without jumps of a turn; what is missing stays missing."""
    known = np.isfinite(angle)
    whole = np.full(len(angle), np.nan)
    whole[known] = np.unwrap(angle[known])
    return whole


def _turns_taken(angle: Array) -> int:
    """How often the angle (n,), rad, jumps by a turn from one sample to the next."""
    known = angle[np.isfinite(angle)]
    return int((np.abs(np.diff(np.unwrap(known) - known)) > np.pi).sum()) if len(known) else 0


LARGEST = 1e12
"""Anything larger is no measurement in any unit, and its square would overflow."""


@dataclass(frozen=True)
class Cleaned:
    """A recording with what was found in it.

    recording  flags set; sigma, where it was not stated, as estimated
    noise      by channel, from its unflagged samples
    jumps      by channel
    doubts     all of this step; not those of the reader
    """

    recording: Recording
    noise: Mapping[str, NoiseEstimate]
    gaps: tuple[Gap, ...]
    jumps: Mapping[str, tuple[Jump, ...]]
    doubts: tuple[Notice, ...]


def clean(recording: Recording) -> Cleaned:
    """Look at every channel of a recording; its own doubts stay with it."""
    recording, inventions = without_inventions(_of_numbers(recording))
    turns = {one: _turns_taken(recording.data(one)) for one in ("psi", "phi")}
    units = tuple(unit_notices(recording))
    turns = {} if units else {one: count for one, count in turns.items() if count}
    recording = _without_turns(recording, turns)
    lacking = np.diff(recording.t) > LACKING * time_step(recording.t)
    flags, sigma, noise, found, steps = {}, {}, {}, {}, {}
    for channel in recording.channels:
        y = recording.data(channel)
        stated = recording.sigma[channel]
        allowed = stated if np.isfinite(stated).all() and (stated > 0).all() else usual_noise(y)
        steps[channel] = step_of(y)
        allowed = np.hypot(allowed, steps[channel] / np.sqrt(12))
        seen = outliers(recording.t, y, allowed)
        flags[channel] = recording.flags[channel] | seen.outlier * np.uint8(Flag.OUTLIER)
        noise[channel] = seen.noise
        unsaid = not np.isfinite(stated).any()
        sigma[channel] = np.full(len(y), seen.sigma) if unsaid else stated
        good = np.where(seen.outlier, np.nan, y)
        all_jumps = jumps(good, max(seen.noise.sigma, 0.5 * float(np.median(allowed))))
        # Where rows are missing, the motion went on unseen.
        found[channel] = tuple(jump for jump in all_jumps if not lacking[jump.row])
    made = replace(recording, sigma=MappingProxyType(sigma), flags=MappingProxyType(flags))
    holes = gaps(made)
    turned = [notice("turns.angle", angle=one, count=n) for one, n in turns.items()]
    channels = channel_notices(made, noise, steps, holes, found, stated=recording.sigma)
    doubts = (*units, *inventions, *turned, *channels)
    return Cleaned(made, MappingProxyType(noise), holes, MappingProxyType(found), doubts)


def _of_numbers(recording: Recording) -> Recording:
    """The same, with values flagged that are no measurement in any unit."""
    flags = {
        channel: np.where(np.abs(recording.data(channel)) > LARGEST, flag | Flag.OUTLIER, flag)
        for channel, flag in recording.flags.items()
    }
    return replace(recording, flags=MappingProxyType(flags))


def _without_turns(recording: Recording, angles: Iterable[str]) -> Recording:
    """The same with the angles that jump by turns unwrapped; flagged samples stay as read."""
    values = dict(recording.values)
    for angle in angles:
        whole = unwrapped(recording.data(angle))
        values[angle] = np.where(np.isfinite(whole), whole, values[angle])
    return replace(recording, values=MappingProxyType(values))


_KEYS = {
    "x": "noise.position",
    "y": "noise.position",
    "psi": "noise.angle",
    "phi": "noise.angle",
    "torque": "noise.torque",
}
_MANY, _FEW = 1.25, 0.8
"""Ratios of estimated to stated noise beyond which the two contradict each other."""
_COLOURED, _ALTERNATING, _CHANCE = 1.2, 0.85, 1e-4
_LONG = 0.1
"""Gaps longer than this are listed one by one, s."""
_LISTED = 3


def channel_notices(
    recording: Recording,
    noise: Mapping[str, NoiseEstimate],
    steps: Mapping[str, float],
    holes: Sequence[Gap],
    found: Mapping[str, Sequence[Jump]],
    stated: Mapping[str, Array],
) -> Iterator[Notice]:
    """Notices on each channel, the jumps and the gaps.

    steps: resolution of each channel's values, in its unit; stated: sigma as the file has it.
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
    """by_fit: the stated noise follows from that of the markers."""
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
        "whose": "follows from the noise of the markers or bodies" if by_fit else "was stated",
        "remedy": "" if by_fit else f"Correct `{_KEYS[channel]}` if it is not as intended.",
    }
    if times > _MANY:
        yield notice("noise.large", **sizes)
    if times < _FEW:
        better = "A better capture than stated?"
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
    """One for each instant at which channels jump; only the first few."""
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
        return "Missing time, or a knock?"
    if channels <= {"x", "y", "psi"} and channels & {"x", "y"}:
        return (
            "Was the floor frame reset, or are two marker labels swapped? Recordings share one "
            "floor frame: cut it there."
        )
    return "A swapped marker label, or a knock?"


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
