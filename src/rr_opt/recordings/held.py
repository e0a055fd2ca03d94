"""Samples that repeat the last one: a stream that stood still while the robot went on."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.recording import CHANNELS, Flag, Recording
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.gaps import runs

_FEWEST = 3
"""Copies in a row, in every channel, that noise does not make."""
_COMMON = 0.2
"""A recording of which a larger part repeats has no noise to tell by: it is computed."""


def without_copies(recording: Recording) -> tuple[Recording, tuple[Doubt, ...]]:
    """The recording with samples that repeat the last one in every channel flagged OUTLIER.

    They are no measurements: a capture that hangs writes its last values again.
    """
    same = np.ones(max(len(recording) - 1, 0), bool)
    for channel in CHANNELS:
        same &= np.diff(recording.data(channel)) == 0
    copied = np.concatenate([[False], same])
    stretches = [(a, b) for a, b in runs(copied) if b - a >= _FEWEST]
    count = sum(b - a for a, b in stretches)
    if not stretches or count > _COMMON * len(recording):
        return recording, ()
    member = _member(len(recording), stretches)
    flags = {
        channel: np.where(member, flag | np.uint8(Flag.OUTLIER), flag).astype(np.uint8)
        for channel, flag in recording.flags.items()
    }
    t = recording.t
    longest = max(stretches, key=lambda one: one[1] - one[0])
    text = (
        f"{count} samples repeat the last one in every channel, {len(stretches)} "
        f"time{'s' if len(stretches) > 1 else ''}, the longest for "
        f"{t[longest[1] - 1] - t[longest[0] - 1]:.3g} s from t = {t[longest[0] - 1]:.6g} s: a "
        "stream that stood still? Flagged."
    )
    return replace(recording, flags=MappingProxyType(flags)), (Doubt("held", text),)


def _member(n: int, stretches: list[tuple[int, int]]) -> NDArray[np.bool_]:
    member = np.zeros(n, bool)
    for a, b in stretches:
        member[a:b] = True
    return member
