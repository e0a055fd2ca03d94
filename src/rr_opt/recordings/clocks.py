"""The clock of a capture against that of the command, and against that of the servo's log.

A pure delay of the servo and a clock that is late are one thing in a recording: both shift phi
against its command by the same time at every instant. Only a start from rest, or a delay that is
not pure (a lag, which also makes the angle smaller), can tell one from the other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from rr_opt.recordings.clock_fit import ClockFit, Reference, clock_fit
from rr_opt.recordings.derivatives import derivatives
from rr_opt.recordings.likeness import peaks
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]

_SHIFTS = 64
_MOST = 6
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

    return likely_fits(t, phi, reference, peaks(t, phi, log.t, angle).tried(near, _MOST))


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
