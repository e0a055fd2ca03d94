"""What is odd about single channels: noise, outliers, jumps, gaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.recording import Flag, Recording
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.gaps import Gap
from rr_opt.recordings.jumps import Jump
from rr_opt.recordings.noise import NoiseEstimate

Array = NDArray[np.float64]

UNITS = {"x": (1e3, "mm"), "y": (1e3, "mm"), "psi": (1e3, "mrad"), "phi": (1e3, "mrad"),
         "torque": (1e3, "mN m")}  # fmt: skip
_MANY, _FEW = 1.25, 0.8
"""Times the stated noise from which on the estimate contradicts it, if it does so surely."""
_SURE = 4.0
_COLOURED, _ALTERNATING, _CHANCE = 1.2, 0.85, 1e-4
_LONG = 0.1
"""Gaps longer than this are told one by one, s."""
_LISTED = 3


def size_text(channel: str, size: float) -> str:
    """A size in the unit people think in: `1.2 mm`."""
    factor, unit = UNITS.get(channel, (1.0, ""))
    return f"{factor * size:.3g} {unit}".strip()


def turn_doubts(turns: Mapping[str, int]) -> tuple[Doubt, ...]:
    """Of angles that jumped by turns and were unwrapped."""
    return tuple(
        Doubt("turns", f"{angle} jumps by a whole turn {count} times. It was unwrapped.")
        for angle, count in turns.items()
        if count
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
    for channel in recording.channels:
        doubts += _of_noise(channel, noise[channel], stated[channel])
        doubts += _of_outliers(recording, channel)
        doubts += _of_jumps(recording, channel, found[channel])
    return (*doubts, *_of_gaps(holes))


def _of_noise(channel: str, noise: NoiseEstimate, stated: Array) -> Iterator[Doubt]:
    if not np.isfinite(noise.sigma):
        yield Doubt("noise", f"{channel} has too few samples in a row to tell its noise.")
        return
    if noise.sigma == 0:
        yield Doubt("noise", f"{channel} has no noise at all: is it computed, or constant?")
        return
    said = float(np.median(stated))
    ratio = noise.sigma / said if said > 0 else np.nan
    sure = abs(noise.sigma - said) > _SURE * noise.error
    coloured = noise.p_white < _CHANCE and noise.colour > _COLOURED
    if sure and ratio > _MANY:
        yield Doubt(
            "noise",
            f"The noise of {channel} is {size_text(channel, noise.sigma)}, and "
            f"{size_text(channel, said)} are stated.",
        )
    if sure and ratio < _FEW:
        why = "A filter upstream?" if coloured else "A better capture than stated?"
        yield Doubt(
            "noise",
            f"The noise of {channel} at the highest frequencies is "
            f"{size_text(channel, noise.sigma)}, less than the {size_text(channel, said)} that are "
            f"stated. {why}",
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


def _of_jumps(recording: Recording, channel: str, found: Sequence[Jump]) -> Iterator[Doubt]:
    if not found:
        return
    largest = max(found, key=lambda jump: abs(jump.size))
    several = f" and {len(found) - 1} times more" if len(found) > 1 else ""
    yield Doubt(
        "jump",
        f"{channel} jumps by {size_text(channel, largest.size)} at "
        f"t = {recording.t[largest.row]:.6g} s{several}: a marker with another's name, or a blow?",
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
