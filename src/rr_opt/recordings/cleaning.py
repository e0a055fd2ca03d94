"""A recording cleaned: angles unwrapped, outliers flagged, noise measured, all that is odd told.

Nothing is filled in, nothing is smoothed and no value is changed but for whole turns of an angle.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import Flag, Recording
from rr_opt.recordings.channel_checks import channel_notices
from rr_opt.recordings.gaps import Gap, Jump, gaps, jumps, without_copies
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.recordings.nuisances.units import unit_notices
from rr_opt.recordings.outliers import outliers, step_of, usual_noise
from rr_opt.recordings.time_axis import LACKING, time_step
from rr_opt.recordings.warnings import Notice, notice


def unwrapped(angle: Array) -> Array:
    """The angle (n,), rad, without jumps of a turn; what is missing stays missing."""
    known = np.isfinite(angle)
    whole = np.full(len(angle), np.nan)
    whole[known] = np.unwrap(angle[known])
    return whole


def turns_taken(angle: Array) -> int:
    """How often the angle (n,), rad, jumps by a turn from one sample to the next."""
    known = angle[np.isfinite(angle)]
    return int((np.abs(np.diff(np.unwrap(known) - known)) > np.pi).sum()) if len(known) else 0


_ANGLES = ("psi", "phi")
_LARGEST = 1e12
"""What is beyond is no measurement in any unit, and would overflow where it is squared."""


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
    recording, copies = without_copies(_of_numbers(recording))
    turns = {one: turns_taken(recording.data(one)) for one in _ANGLES}
    units = unit_notices(recording)
    if units:
        turns = {}
    recording = _without_turns(recording, turns)
    lacking = np.diff(recording.t) > LACKING * time_step(recording.t)
    values, flags, sigma, noise, found, steps = {}, {}, {}, {}, {}, {}
    for channel in recording.channels:
        y = recording.data(channel)
        stated = recording.sigma[channel]
        told = stated if np.isfinite(stated).all() and (stated > 0).all() else usual_noise(y)
        steps[channel] = step_of(y)
        told = np.hypot(told, steps[channel] / np.sqrt(12))
        seen = outliers(recording.t, y, told)
        values[channel] = recording.values[channel]
        flags[channel] = recording.flags[channel] | np.where(
            seen.outlier, np.uint8(Flag.OUTLIER), np.uint8(0)
        ).astype(np.uint8)
        noise[channel] = seen.noise
        unsaid = not np.isfinite(stated).any()
        sigma[channel] = np.full(len(y), seen.sigma) if unsaid else stated
        good = np.where(seen.outlier, np.nan, y)
        all_jumps = jumps(good, max(seen.noise.sigma, 0.5 * float(np.median(told))))
        # Where rows are lacking, the motion went on unseen.
        found[channel] = tuple(jump for jump in all_jumps if not lacking[jump.row])
    made = replace(recording, sigma=MappingProxyType(sigma), flags=MappingProxyType(flags))
    holes = gaps(made)
    turned = [notice("turns.angle", angle=one, count=n) for one, n in turns.items() if n]
    channels = channel_notices(made, noise, steps, holes, found, stated=recording.sigma)
    doubts = (*units, *copies, *turned, *channels)
    return Cleaned(made, MappingProxyType(noise), holes, MappingProxyType(found), doubts)


def _of_numbers(recording: Recording) -> Recording:
    """The same with what is no measurement in any unit flagged."""
    flags = {
        channel: np.where(np.abs(recording.data(channel)) > _LARGEST, flag | Flag.OUTLIER, flag)
        for channel, flag in recording.flags.items()
    }
    return replace(recording, flags=MappingProxyType(flags))


def _without_turns(recording: Recording, turns: Mapping[str, int]) -> Recording:
    """The same with the angles that jump by turns unwrapped; flagged samples stay as read."""
    values = dict(recording.values)
    for angle, count in turns.items():
        if count:
            whole = unwrapped(recording.data(angle))
            values[angle] = np.where(np.isfinite(whole), whole, values[angle])
    return replace(recording, values=MappingProxyType(values))
