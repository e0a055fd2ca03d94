"""The clock of a capture against that of the command, and against that of the servo's log.

A pure delay of the servo and a clock that is late are one thing in a recording: both shift phi
against its command by the same time at every instant. Only a start from rest, or a delay that is
not pure (a lag, which also makes the angle smaller), can tell one from the other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from rr_opt.array import Array
from rr_opt.model.gait import Gait
from rr_opt.recordings.clocks.clock_fit import ClockFit, Reference, clock_fit, peaks
from rr_opt.recordings.readers.servo_log import ServoLog
from rr_opt.recordings.smoothing import derivatives

_SHIFTS = 64
_CLOCKS_MOST = 6
"""Likest peaks, and longest ones, that are fitted."""
_APART = 0.02
"""Offsets that are closer are one, s."""
_AS_GOOD = 1.25
"""Times the residual of the best offset with which another is as likely."""


def command_reference(gait: Gait, *, from_rest: bool) -> Reference:
    """The command and its rate; from_rest: its first angle is held before its time 0."""

    def reference(u: Array) -> tuple[Array, Array]:
        if not from_rest:
            return gait.angle(u), gait.rate(u)
        begun = np.maximum(u, 0.0)
        return gait.angle(begun), np.where(u < 0, 0.0, gait.rate(begun))

    return reference


def against_command(
    t: Array, phi: Array, gait: Gait, *, from_rest: bool = False
) -> ClockFit | None:
    """phi (n,), rad, seen at t (n,), s, against its command; None if it cannot be matched.

    The offset is sought within half a period to either side. A negative one is a phi that lags.
    from_rest: the command begins at its time 0, and its first angle is held before.
    """
    reference = command_reference(gait, from_rest=from_rest)
    shifts = (np.arange(_SHIFTS) / _SHIFTS - 0.5) * gait.period
    start = _best_shift(t, phi, reference, shifts)
    return None if start is None else clock_fit(t, phi, reference, start)


def _best_shift(t: Array, phi: Array, reference: Reference, shifts: Array) -> float | None:
    known = np.flatnonzero(np.isfinite(phi))
    known = known[:: max(1, len(known) // 2000)]
    if len(known) < 2 or np.ptp(phi[known]) == 0:
        return None
    seen = phi[known] - phi[known].mean()
    alike = []
    for shift in shifts:
        g, _ = reference(t[known] + shift)
        g = g - g.mean()
        alike.append(float(seen @ g) / max(float(np.linalg.norm(g)), 1e-300))
    return float(shifts[int(np.argmax(alike))])


def against_log(
    t: Array, phi: Array, log: ServoLog, near: tuple[float, ...] = ()
) -> tuple[ClockFit, ...]:
    """phi as the capture saw it against the servo's log, on the log's clock: all likely fits.

    Against `present` if the log has it, else against `goal`. A motion that only repeats itself
    leaves whole periods open, so there may be many; the longest overlap is first. near: offsets, s,
    about which one is tried in any case. None at all if the two share no motion.
    """
    angle = log.present_angle if log.present_angle is not None else log.goal_angle
    if angle is None:
        return ()
    smooth = derivatives(log.t, angle, log.resolution / np.sqrt(12))
    known = np.isfinite(smooth.value)
    if known.sum() < 2:
        return ()
    curve = CubicHermiteSpline(log.t[known], smooth.value[known], smooth.first[known])
    slope = curve.derivative()
    first, last = log.t[known][[0, -1]]

    def reference(u: Array) -> tuple[Array, Array]:
        inside = (u >= first) & (u <= last)
        return np.where(inside, curve(u), np.nan), np.where(inside, slope(u), np.nan)

    return likely_fits(t, phi, reference, peaks(t, phi, log.t, angle).tried(near, _CLOCKS_MOST))


def likely_fits(
    t: Array, phi: Array, reference: Reference, offsets: list[float]
) -> tuple[ClockFit, ...]:
    """The fits from some offsets, s, that are about as good as the best; most samples first."""
    tried = (clock_fit(t, phi, reference, one) for one in offsets)
    fits = sorted((fit for fit in tried if fit is not None), key=lambda fit: fit.residual)
    good = [fit for fit in fits if fit.residual <= _AS_GOOD * fits[0].residual]
    good.sort(key=lambda fit: -fit.samples)
    apart: list[ClockFit] = []
    for fit in good:
        if all(abs(fit.offset - other.offset) > _APART for other in apart):
            apart.append(fit)
    return tuple(apart)


_IN_PERIOD = 16
"""Starts of the fit in a period of the command."""
_LOOKED_AT = 400
"""Samples that the starts are compared on."""
_MOST = 6


def goal_fits(log: ServoLog, gait: Gait, *, from_rest: bool) -> tuple[ClockFit, ...]:
    """The log's goal against the command: all likely fits, the command's time being t + offset.

    from_rest: the command's first angle is held before its time 0, which shows when it began if
    the log goes back so far. Otherwise whole periods stay open. Empty without a goal that moves.
    """
    goal = log.goal_angle
    if goal is None:
        return ()
    moving = np.flatnonzero(np.isfinite(goal))
    moving = moving[_commanded(goal[moving], from_rest=from_rest)]
    if len(moving) < 2:
        return ()
    t, goal = log.t[moving], goal[moving]
    reference = command_reference(gait, from_rest=from_rest)
    step = gait.period / _IN_PERIOD
    # A periodic command is the same a period later; one that begins is not.
    span = t[-1] - t[0] if from_rest else 0.0
    shifts = np.arange(-t[0] - span, -t[0] + gait.period, step)
    look = np.linspace(0, len(t) - 1, min(_LOOKED_AT, len(t))).astype(int)
    off = np.array([_off(goal[look], reference(t[look] + one)[0]) for one in shifts])
    lowest = [
        i for i in range(len(off))
        if off[i] <= off[max(i - 1, 0)] and off[i] <= off[min(i + 1, len(off) - 1)]
    ]  # fmt: skip
    lowest.sort(key=lambda i: off[i])
    return likely_fits(t, goal, reference, [float(shifts[i]) for i in lowest[:_MOST]])


def _commanded(goal: Array, *, from_rest: bool) -> NDArray[np.bool_]:
    """Without the time after the last change, and unless it tells the start, before the first."""
    changes = np.flatnonzero(np.diff(goal))
    row = np.arange(len(goal))
    if not len(changes):
        return np.zeros(len(goal), bool)
    return (row <= changes[-1] + 1) & ((row >= changes[0]) | from_rest)


def _off(goal: Array, told: Array) -> float:
    """Root mean square difference, but for a constant: phi's zero is not the clock's affair."""
    return float(np.std(goal - told))


_SURE = 3.0
_COVERED = 1.959964
_LOSS = 1e-3
"""phi may move by so much less than the servo's shaft before play is suspected."""


@dataclass(frozen=True)
class Shift:
    """The command's time is t + offset + drift (t - t_mid).

    offset, drift  s, and s per s; sigma: their standard deviations
    play           by how much of the offset phi may be late behind the servo's shaft, s, as what
                   gives between them makes phi move less
    applied        whether the recording was moved: only if the offset or the drift is surely there
    """

    offset: float
    drift: float
    sigma: tuple[float, float]
    t_mid: float
    play: float
    applied: bool

    def of(self, t: Array) -> Array:
        """The command's times of the recording's times t (n,), s."""
        return t + self.offset + self.drift * (t - self.t_mid)

    def interval(self, which: int = 0) -> tuple[float, float]:
        """95 % interval of the offset (0), s, or of the drift (1)."""
        value, half = (self.offset, self.drift)[which], _COVERED * self.sigma[which]
        return value - half, value + half

    def __str__(self) -> str:
        low, high = self.interval()
        return (
            f"t {self.offset:+.5f} s (95 %: {low:+.5f} to {high:+.5f} s), and gains "
            f"{1e6 * self.drift:+.3g} +- {_COVERED * 1e6 * self.sigma[1]:.2g} us a second"
        )


def shift_of(log: ClockFit, goal: ClockFit, period: float, *, rest: bool) -> Shift:
    """The two fits as one; the capture's time to the log's, and the log's to the command's.

    rest: the command has a beginning. Otherwise it is the same a period (s) later, and the shift
    nearest to none is told.
    """
    since = log.t_mid + log.offset - goal.t_mid
    offset = log.offset + goal.offset + goal.drift * since
    if not rest:
        offset -= period * round(offset / period)
    drift = (1 + log.drift) * (1 + goal.drift) - 1
    sigma = (
        math.hypot(log.sigma[0], goal.sigma[0], since * goal.sigma[1]),
        math.hypot(log.sigma[1], goal.sigma[1]),
    )
    loses = log.scale < 1 - max(_LOSS, _SURE * log.sigma[2])
    play = math.acos(max(log.scale, 0.0)) * period / (2 * math.pi) if loses else 0.0
    sure = abs(offset) > max(_SURE * sigma[0], play) or (
        abs(drift) > _SURE * sigma[1] and not loses
    )
    return Shift(offset, drift, sigma, log.t_mid, play, sure)
