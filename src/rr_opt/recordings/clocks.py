"""The clock of a capture against that of the command, and against that of the servo's log.

A pure delay of the servo and a clock that is late are one thing in a recording: both shift phi
against its command by the same time at every instant. Only a start from rest, or a delay that is
not pure (a lag, which also makes the angle smaller), can tell one from the other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline
from scipy.signal import correlate

from rr_opt.recordings.clock_fit import ClockFit, Reference, clock_fit
from rr_opt.recordings.derivatives import derivatives
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.robot.gait import Gait

Array = NDArray[np.float64]

_SHIFTS = 64
_COMMON = 0.02
"""Step at which two recordings are compared all along, s."""
_OVERLAP = 0.2
"""The part of the shorter recording that has to overlap."""
_PEAK, _PEAKS = 0.9, 12
"""Peaks of the likeness that are tried: so high relative to the best, and at most so many."""
_AS_GOOD = 1.1
"""Times the residual of the best offset with which another is as likely."""


def against_command(
    t: Array, phi: Array, gait: Gait, *, from_rest: bool = False
) -> ClockFit | None:
    """phi (n,), rad, seen at t (n,), s, against its command; None if it cannot be matched.

    The offset is sought within half a period to either side. A negative one is a phi that lags.
    from_rest: the command begins at its time 0, and its first angle is held before.
    """

    def reference(u: Array) -> tuple[Array, Array]:
        if not from_rest:
            return gait.angle(u), gait.rate(u)
        begun = np.maximum(u, 0.0)
        return gait.angle(begun), np.where(u < 0, 0.0, gait.rate(begun))

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


def against_log(t: Array, phi: Array, log: ServoLog) -> tuple[ClockFit | None, tuple[float, ...]]:
    """phi as the capture saw it against the servo's log, on the log's clock.

    Against `present` if the log has it, else against `goal`. Also returns the other offsets, s,
    that are about as likely, as a periodic motion leaves whole periods open. None if the two do not
    overlap or do not move.
    """
    angle = log.present_angle if log.present_angle is not None else log.goal_angle
    if angle is None:
        return None, ()
    smooth = derivatives(log.t, angle, log.resolution / np.sqrt(12))
    known = np.isfinite(smooth.value)
    if known.sum() < 2:
        return None, ()
    curve = CubicHermiteSpline(log.t[known], smooth.value[known], smooth.first[known])
    slope = curve.derivative()
    first, last = log.t[known][[0, -1]]

    def reference(u: Array) -> tuple[Array, Array]:
        inside = (u >= first) & (u <= last)
        return np.where(inside, curve(u), np.nan), np.where(inside, slope(u), np.nan)

    tried = (clock_fit(t, phi, reference, one) for one in _likely_offsets(t, phi, log.t, angle))
    fits = sorted((fit for fit in tried if fit is not None), key=lambda fit: fit.residual)
    if not fits:
        return None, ()
    best = fits[0]
    apart = [one for one in fits[1:] if abs(one.offset - best.offset) > _COMMON]
    return best, tuple(one.offset for one in apart if one.residual < _AS_GOOD * best.residual)


def _likely_offsets(t: Array, phi: Array, s: Array, angle: Array) -> tuple[float, ...]:
    """Offsets from t to s at which the two are most alike."""
    one, two = _resampled(t, phi), _resampled(s, angle)
    if one is None or two is None:
        return ()
    alike = correlate(two, one, method="fft")
    overlap = correlate(np.ones(len(two)), np.ones(len(one)), method="fft")
    size = np.sqrt(
        np.maximum(correlate(two**2, np.ones(len(one)), method="fft"), 0)
        * np.maximum(correlate(np.ones(len(two)), one**2, method="fft"), 0)
    )
    fits = overlap > _OVERLAP * min(len(one), len(two))
    score = np.where(fits, alike / np.maximum(size, 1e-12), -1.0)
    peak = np.r_[False, (score[1:-1] > score[:-2]) & (score[1:-1] >= score[2:]), False]
    rows = np.flatnonzero(peak & (score > _PEAK * score.max()) & (score > 0))
    rows = rows[np.argsort(-score[rows])][:_PEAKS]
    lag = (rows - (len(one) - 1)) * _COMMON
    return tuple((s[0] - t[0] + lag).tolist())


def _resampled(t: Array, y: Array) -> Array | None:
    known = np.isfinite(y)
    if known.sum() < 2 or not 0 < t[-1] - t[0] < 1e6 * _COMMON:
        return None
    grid = np.arange(t[0], t[-1], _COMMON)
    z = np.interp(grid, t[known], y[known])
    z = z - z.mean()
    return z if np.abs(z).max() > 0 else None
