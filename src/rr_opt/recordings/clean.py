"""A recording cleaned: angles unwrapped, outliers flagged, noise measured, and every doubt told.

Nothing is filled in, nothing is smoothed and no value is changed but for whole turns of an angle.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.recording import Flag, Recording
from rr_opt.recordings.channel_doubts import channel_doubts, turn_doubts
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.gaps import Gap, gaps
from rr_opt.recordings.jumps import Jump, jumps
from rr_opt.recordings.motion_doubts import motion_doubts
from rr_opt.recordings.noise import NoiseEstimate, noise_of
from rr_opt.recordings.outliers import outliers
from rr_opt.recordings.units_guess import unit_doubts
from rr_opt.recordings.wrapping import turns_taken, unwrapped

Array = NDArray[np.float64]

_ANGLES = ("psi", "phi")
_LARGEST = 1e12
"""What is beyond is no measurement in any unit, and would overflow where it is squared."""


@dataclass(frozen=True)
class Cleaned:
    """A recording with what was found in it.

    recording  flags set; sigma, where it was not stated, as estimated
    noise      by channel, from its unflagged samples
    jumps      by channel
    doubts     in sentences, all of this step; not those of the reader
    """

    recording: Recording
    noise: Mapping[str, NoiseEstimate]
    gaps: tuple[Gap, ...]
    jumps: Mapping[str, tuple[Jump, ...]]
    doubts: tuple[Doubt, ...]


def clean(recording: Recording) -> Cleaned:
    """Look at every channel of a recording; its own doubts stay with it."""
    recording = _of_numbers(recording)
    turns = {one: turns_taken(recording.data(one)) for one in _ANGLES}
    units = unit_doubts(recording)
    if not any(doubt.kind == "units" for doubt in units):
        recording = _without_turns(recording, turns)
    else:
        turns = {}
    values, flags, sigma, noise, found = {}, {}, {}, {}, {}
    for channel in recording.channels:
        y = recording.data(channel)
        stated = recording.sigma[channel]
        told = stated if np.isfinite(stated).all() and (stated > 0).all() else _estimated(y)
        seen = outliers(recording.t, y, told)
        values[channel] = recording.values[channel]
        flags[channel] = recording.flags[channel] | np.where(
            seen.outlier, np.uint8(Flag.OUTLIER), np.uint8(0)
        ).astype(np.uint8)
        noise[channel] = seen.noise
        unsaid = not np.isfinite(stated).any()
        sigma[channel] = np.full(len(y), seen.noise.sigma) if unsaid else stated
        good = np.where(seen.outlier, np.nan, y)
        found[channel] = jumps(good, max(seen.noise.sigma, 0.5 * float(np.median(told))))
    made = replace(
        recording,
        sigma=MappingProxyType(sigma),
        flags=MappingProxyType(flags),
    )
    holes = gaps(made)
    doubts = (
        *units,
        *turn_doubts(turns),
        *motion_doubts(made, noise, stated=recording.sigma),
        *channel_doubts(made, noise, holes, found, stated=recording.sigma),
    )
    return Cleaned(made, MappingProxyType(noise), holes, MappingProxyType(found), doubts)


def _of_numbers(recording: Recording) -> Recording:
    """The same with what is no measurement in any unit flagged."""
    flags = {
        channel: np.where(np.abs(recording.data(channel)) > _LARGEST, flag | Flag.OUTLIER, flag)
        for channel, flag in recording.flags.items()
    }
    return replace(recording, flags=MappingProxyType(flags))


def _estimated(y: Array) -> Array:
    """The noise of a channel of which none is stated, (n,); never zero."""
    sigma = noise_of(y).sigma
    size = float(np.nanmax(np.abs(y))) if np.isfinite(y).any() else 1.0
    least = max(1e-9 * size, 1e-12)
    return np.full(len(y), max(sigma, least) if np.isfinite(sigma) else max(size, least))


def _without_turns(recording: Recording, turns: Mapping[str, int]) -> Recording:
    """The same with the angles that jump by turns unwrapped; flagged samples stay as read."""
    values = dict(recording.values)
    for angle, count in turns.items():
        if count:
            whole = unwrapped(recording.data(angle))
            values[angle] = np.where(np.isfinite(whole), whole, values[angle])
    return replace(recording, values=MappingProxyType(values))
