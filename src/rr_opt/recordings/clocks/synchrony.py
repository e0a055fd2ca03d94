"""A recording put on the command's clock by way of the servo's log.

Two steps lead from the capture's time to the command's: phi against the log's present position
tells the log's time, and the log's goal against the gait tells the command's. What the servo is
late by lies between goal and present, so it stays in the recording; the clocks' part is taken out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import Recording, Start
from rr_opt.model.gait import Gait
from rr_opt.recordings.clocks.clock_fit import ClockFit
from rr_opt.recordings.clocks.clocks import Shift, against_log, goal_fits, shift_of
from rr_opt.recordings.outliers import outliers
from rr_opt.recordings.readers.servo_log import ServoLog
from rr_opt.recordings.warnings import Doubt, texts

_LESS, _SURE = 0.01, 3.0
_LEFT = 0.5
"""The part of phi's motion that may be left, before it is another motion than the log's."""
_ANOTHER = 0.05
"""By how much the goal's amplitude may differ from the gait's."""


def unlike(fit: ClockFit, phi: Array) -> bool:
    """Whether phi (n,), rad, is another motion than the log's."""
    return fit.scale <= 0 or fit.residual > _LEFT * float(np.nanstd(phi))


def log_doubts(
    fit: ClockFit | None, goal: ClockFit | None, shift: Shift | None, others: tuple[float, ...]
) -> tuple[Doubt, ...]:
    """All of them; fit: phi against the log; goal: its goal against the gait; others: offsets, s,
    as likely as the one taken."""
    if fit is None:
        text = "phi and the servo's log share no motion: another run's log? It was not used."
        return (Doubt("log", text),)
    return tuple(_of_log(fit, goal, shift, others))


def _of_log(
    fit: ClockFit, goal: ClockFit | None, shift: Shift | None, others: tuple[float, ...]
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


_SAME = 0.02
"""Offsets that are closer are one, s."""


@dataclass(frozen=True)
class Synchrony:
    """What the servo's log says about a recording's clock.

    recording  on the command's clock, if `shift` was applied
    log        phi against the log; None if they share no motion
    goal       the log's goal against the gait; None without a gait or a goal
    shift      from the recording's own clock to the command's; None if it cannot be told
    """

    recording: Recording
    log: ClockFit | None
    goal: ClockFit | None
    shift: Shift | None
    doubts: tuple[Doubt, ...]


def synchronised(
    recording: Recording, log: ServoLog, gait: Gait | None, start: Start = "running"
) -> Synchrony:
    """The recording on the command's clock, as far as the log can tell it; it is not cleaned yet.

    gait: what was commanded; without it the clocks are compared, and nothing is shifted. Of offsets
    that are as likely the one is taken that shifts the recording least, and of those the one
    that most samples tell.
    """
    t, phi = recording.t, _phi(recording)
    # Against its goal alone phi's clock has the servo's lag in it.
    goals = (
        goal_fits(log, gait, from_rest=start == "rest")
        if gait is not None and log.present_angle is not None
        else ()
    )
    fits = against_log(t, phi, log, tuple(-one.offset for one in goals))
    if not fits or unlike(fits[0], phi):
        return Synchrony(recording, None, None, None, log_doubts(None, None, None, ()))
    period = gait.period if gait else math.nan
    pairs = [(one, two) for one in fits for two in goals or (None,)]
    shifts = [
        None if two is None else shift_of(one, two, period, rest=start == "rest")
        for one, two in pairs
    ]
    sizes = [0.0 if one is None else abs(one.offset) for one in shifts]
    nearest = [i for i, size in enumerate(sizes) if size < min(sizes) + _SAME]
    best = max(nearest, key=lambda i: pairs[i][0].samples)
    (fit, goal), shift = pairs[best], shifts[best]
    others = tuple(one.offset for one in fits if one is not fit)
    if shift is not None:
        # A shift by less than half a period is the one that was meant.
        far = start == "rest" and abs(shift.offset) > period / 2
        others = _apart([one.offset for one in shifts if one], shift.offset) if far else ()
    if shift is not None and shift.applied:
        recording = replace(recording, t=shift.of(t))
    doubts = log_doubts(fit, goal, shift, others)
    return Synchrony(_told(recording, log, shift), fit, goal, shift, doubts)


def _apart(offsets: list[float], taken: float) -> tuple[float, ...]:
    """Those that are not the one taken, nearest to it first, s."""
    apart = {round(one, 2): one for one in offsets if abs(one - taken) > _SAME}
    return tuple(sorted(apart.values(), key=lambda one: abs(one - taken)))


def with_doubts(made: Synchrony) -> Recording:
    """The recording with what was said of its clock."""
    doubts = (*made.recording.doubts, *texts(made.doubts))
    return replace(made.recording, doubts=doubts)


def _phi(recording: Recording) -> Array:
    """phi without outliers, which would pull at the clock."""
    phi, sigma = recording.data("phi"), recording.sigma["phi"]
    if not (np.isfinite(sigma) & (sigma > 0)).all():
        return phi
    return np.where(outliers(recording.t, phi, sigma).outlier, np.nan, phi)


def _told(recording: Recording, log: ServoLog, shift: Shift | None) -> Recording:
    told: dict[str, str] = {"servo log": f"{log.name}, {log.rate:.6g} Hz"}
    if shift is not None and shift.applied:
        told["clock"] = f"the command's, by the servo's log: the recording's {shift}"
    elif shift is not None:
        told["servo log"] += f"; the command's clock is the recording's {shift}: not shifted"
    return replace(recording, source=MappingProxyType({**recording.source, **told}))
