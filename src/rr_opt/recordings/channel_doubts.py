"""What is odd about single channels: noise, outliers, jumps, gaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.recording import Flag, Recording
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.gaps import Gap
from rr_opt.recordings.jump_doubts import jump_doubts
from rr_opt.recordings.jumps import Jump
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.recordings.sizes import size_text

Array = NDArray[np.float64]

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
