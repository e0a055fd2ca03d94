"""A recording put on the command's clock by way of the servo's log.

Two steps lead from the capture's time to the command's: phi against the log's present position
tells the log's time, and the log's goal against the gait tells the command's. What the servo is
late by lies between goal and present, so it stays in the recording; the clocks' part is taken out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.experiment.experiment import Start
from rr_opt.experiment.recording import Recording
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.clocks import against_log
from rr_opt.recordings.doubts import Doubt, texts
from rr_opt.recordings.goal_fit import goal_fits
from rr_opt.recordings.log_doubts import log_doubts, unlike
from rr_opt.recordings.outliers import outliers
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.recordings.shift import Shift, shift_of
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]

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
