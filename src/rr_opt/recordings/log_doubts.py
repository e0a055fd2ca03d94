"""What a servo's log says about clocks, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.doubts import Doubt
from rr_opt.recordings.shift import Shift

Array = NDArray[np.float64]

_LESS, _SURE = 0.01, 3.0
_LEFT = 0.5
"""The part of phi's motion that may be left, before it is another motion than the log's."""
_ANOTHER = 0.05
"""By how much the goal's amplitude may differ from the gait's."""


def unlike(fit: ClockFit, phi: Array) -> bool:
    """Whether phi (n,), rad, is another motion than the log's."""
    return fit.scale <= 0 or fit.residual > _LEFT * float(np.nanstd(phi))


def log_doubts(
    fit: ClockFit | None,
    goal: ClockFit | None,
    shift: Shift | None,
    others: tuple[float, ...],
) -> tuple[Doubt, ...]:
    """All of them; fit: phi against the log; goal: its goal against the gait; others: offsets, s,
    as likely as the one taken."""
    if fit is None:
        text = "phi and the servo's log share no motion: another run's log? It was not used."
        return (Doubt("log", text),)
    return tuple(_of_log(fit, goal, shift, others))


def _of_log(
    fit: ClockFit,
    goal: ClockFit | None,
    shift: Shift | None,
    others: tuple[float, ...],
) -> Iterator[Doubt]:
    low, high = fit.interval(0)
    if shift is None:
        yield Doubt(
            "log",
            f"The servo's clock is {fit.offset:+.4f} s against the capture's (95 %: {low:+.4f} to "
            f"{high:+.4f} s), and gains {1e6 * fit.drift:+.3g} +- {1.96e6 * fit.sigma[1]:.2g} us a "
            "second. Nothing was shifted: that takes `goal` and `present` in the log, and the "
            "gait.",
        )
    else:
        yield from _of_shift(shift)
    if goal is not None and abs(goal.scale - 1) > _ANOTHER:
        yield Doubt(
            "log",
            f"The log's goal moves {goal.scale:.4g} times as far as the gait that is written: "
            "another gait, another run's log, or another count scale?",
        )
    if others:
        also = ", ".join(f"{other:+.3f}" for other in others[:3])
        yield Doubt(
            "log",
            f"The motion repeats itself, and offsets of {also} s fit about as well. The one "
            f"{'nearest to none' if shift else 'of the longest overlap'} was taken. Start both "
            "recordings before the command.",
        )
    if abs(fit.scale - 1) > max(_LESS, _SURE * fit.sigma[2]):
        yield Doubt(
            "log",
            f"phi moves {fit.scale:.4g} times as far as the servo's log has it: its count "
            "scale, or play between servo and platform?",
        )


def _of_shift(shift: Shift) -> Iterator[Doubt]:
    low, high = (1e3 * end for end in shift.interval())
    told = f"{1e3 * shift.offset:+.3g} ms (95 %: {low:+.3g} to {high:+.3g} ms)"
    play = ""
    if shift.play:
        play = (
            " phi moves less than the servo's shaft. What gives between them may make it late by "
            f"up to {1e3 * shift.play:.2g} ms, and that looks like an offset too."
        )
    if shift.applied:
        yield Doubt(
            "clock",
            f"By the servo's log the command's clock is ahead of the recording's by {told}, and "
            f"gains {1e6 * shift.drift:+.3g} +- {1.96e6 * shift.sigma[1]:.2g} us a second. The "
            f"recording was put on the command's clock; what was told of reading it has the file's."
            f"{play}",
        )
    elif shift.play:
        yield Doubt(
            "clock",
            f"By the servo's log the command's clock is ahead of the recording's by {told}.{play} "
            "Nothing was shifted.",
        )
