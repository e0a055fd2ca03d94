"""Jumps in sentences: which channels jump together says what may have happened."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from rr_opt.experiment.recording import Recording
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.jumps import Jump
from rr_opt.recordings.sizes import size_text

_TOGETHER = 2
"""Rows within which jumps are one event."""
_LISTED = 3


def jump_doubts(recording: Recording, found: Mapping[str, Sequence[Jump]]) -> Iterator[Doubt]:
    """A sentence for each instant at which channels jump, the first ones."""
    events = _events(found)
    for row, sizes in events[:_LISTED]:
        listed = ", ".join(f"{name} by {size_text(name, size)}" for name, size in sizes.items())
        yield Doubt("jump", f"At t = {recording.t[row]:.6g} s jumps {listed}: {_why(set(sizes))}")
    if len(events) > _LISTED:
        yield Doubt("jump", f"There are {len(events) - _LISTED} more jumps.")


def _events(found: Mapping[str, Sequence[Jump]]) -> list[tuple[int, dict[str, float]]]:
    """Rows, and the size by channel of what jumps there."""
    events: list[tuple[int, dict[str, float]]] = []
    jumps = sorted((jump.row, channel, jump.size) for channel in found for jump in found[channel])
    for row, channel, size in jumps:
        if events and row - events[-1][0] <= _TOGETHER and channel not in events[-1][1]:
            events[-1][1][channel] = size
        else:
            events.append((row, {channel: size}))
    return events


def _why(channels: set[str]) -> str:
    if "phi" in channels and len(channels) > 1:
        return "time that is missing, or a blow?"
    if channels <= {"x", "y", "psi"} and channels & {"x", "y"}:
        return (
            "the floor frame was set anew, or a marker has another's name? Recordings share one "
            "floor frame: cut it there."
        )
    return "a marker with another's name, or a blow?"
