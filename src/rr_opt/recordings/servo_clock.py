"""A recording put on the command's clock by way of the servo's log.

Two steps lead from the capture's time to the command's: phi against the log's present position
gives the log's time, and the log's goal against the gait the command's. The servo's lag is between
goal and present, so it stays in the recording; only the offset of the clocks is removed.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import Recording, Start
from rr_opt.model.gait import Gait
from rr_opt.recordings.clock_fit import (
    COVERED,
    ClockFit,
    ClockShift,
    Reference,
    clock_fit,
    command_reference,
)
from rr_opt.recordings.outliers import outliers
from rr_opt.recordings.readers.plain_csv import ServoLog
from rr_opt.recordings.smoothing import derivatives
from rr_opt.recordings.warnings import Notice, notice

_STEP = 0.02
"""Time step at which two recordings are compared, s."""
_OVERLAP = 0.2
"""The fraction of the shorter recording that has to overlap."""
_PEAK = 0.9
"""Height relative to the best from which a peak is likely."""
_LONGEST = 20_000.0
"""Longer recordings are not compared, s."""


_TRIED = 6
"""Offsets of each kind from which a fit is tried."""
_APART = 0.02
"""Offsets closer than this are the same, s."""
_AS_GOOD = 1.25
"""Ratio to the best offset's residual up to which another is as likely."""


def offsets_alike(
    t: Array, one: Array, s: Array, two: Array, near: tuple[float, ...] = ()
) -> list[float]:
    """Offsets from t to s, s, worth a fit, where `one` is seen at t (n,) and `two` at s (m,).

    Those at which the signals are most alike, those of the longest overlap, and those nearest to
    `near`; a periodic motion has one per period. NaN is no sample.
    """
    # Here and not above: it takes half a second to load, and only servo logs need it.
    from scipy.signal import correlate

    first, second = _resampled(t, one), _resampled(s, two)
    if first is None or second is None:
        return []
    alike = correlate(second, first, method="fft")
    overlap = correlate(np.ones(len(second)), np.ones(len(first)), method="fft")
    size = np.sqrt(
        np.maximum(correlate(second**2, np.ones(len(first)), method="fft"), 0)
        * np.maximum(correlate(np.ones(len(second)), first**2, method="fft"), 0)
    )
    fits = overlap > _OVERLAP * min(len(first), len(second))
    score = np.where(fits, alike / np.maximum(size, 1e-12), -1.0)
    peak = np.r_[False, (score[1:-1] > score[:-2]) & (score[1:-1] >= score[2:]), False]
    rows = np.flatnonzero(peak & (score > _PEAK * score.max()) & (score > 0))
    if not len(rows):
        return []
    offset = s[0] - t[0] + (rows - (len(first) - 1)) * _STEP
    likest = np.argsort(-score[rows], kind="stable")[:_TRIED]
    longest = np.argsort(-score[rows] * overlap[rows], kind="stable")[:_TRIED]
    nearest = [int(np.abs(offset - one).argmin()) for one in near]
    return offset[sorted({*likest.tolist(), *longest.tolist(), *nearest})].tolist()


def _resampled(t: Array, y: Array) -> Array | None:
    known = np.isfinite(y)
    if known.sum() < 2 or not 0 < t[-1] - t[0] < _LONGEST:
        return None
    z = np.interp(np.arange(t[0], t[-1], _STEP), t[known], y[known])
    z = z - z.mean()
    return z if np.abs(z).max() > 0 else None


def against_log(
    t: Array, phi: Array, log: ServoLog, near: tuple[float, ...] = ()
) -> tuple[ClockFit, ...]:
    """The captured phi against the servo's log, on the log's clock: all likely fits.

    Against `present` if the log has it, else against `goal`. A motion that only repeats itself
    leaves whole periods open, so there may be many; the longest overlap is first. near: offsets, s,
    about which one is tried in any case. None at all if the two share no motion.
    """
    # Here and not above: only servo logs need it.
    from scipy.interpolate import CubicHermiteSpline

    angle = log.present_angle if log.present_angle is not None else log.goal_angle
    if angle is None:
        return ()
    smooth = derivatives(log.t, angle, log.resolution / np.sqrt(12))
    known = np.isfinite(smooth.value)
    if known.sum() < 2:
        return ()
    curve = CubicHermiteSpline(
        log.t[known], smooth.value[known], smooth.first[known], extrapolate=False
    )
    slope = curve.derivative()
    offsets = offsets_alike(t, phi, log.t, angle, near)
    return likely_fits(t, phi, lambda u: (curve(u), slope(u)), offsets)


def likely_fits(
    t: Array, phi: Array, reference: Reference, offsets: list[float]
) -> tuple[ClockFit, ...]:
    """The fits from some offsets, s, that are about as good as the best; most samples first."""
    fits = [fit for one in offsets if (fit := clock_fit(t, phi, reference, one)) is not None]
    best = min((fit.residual for fit in fits), default=0.0)
    apart: list[ClockFit] = []
    for fit in sorted(fits, key=lambda fit: (-fit.samples, fit.residual)):
        if fit.residual <= _AS_GOOD * best and all(
            abs(fit.offset - other.offset) > _APART for other in apart
        ):
            apart.append(fit)
    return tuple(apart)


_IN_PERIOD = 16
"""Initial offsets of the fit per period of the command."""
_LOOKED_AT = 400
"""Samples on which these are compared."""


def goal_fits(log: ServoLog, gait: Gait, *, from_rest: bool) -> tuple[ClockFit, ...]:
    """The log's goal against the command: all likely fits, the command's time being t + offset.

    from_rest: the command's first angle is held before its time 0, which shows when it began if
    the log goes back so far. Otherwise whole periods stay open. Empty without a goal that moves.
    """
    if log.goal_angle is None:
        return ()
    known = np.isfinite(log.goal_angle)
    t, goal = log.t[known], log.goal_angle[known]
    changes = np.flatnonzero(np.diff(goal))
    if not len(changes):
        return ()
    # After its last change the command is over; before the first it may not have begun.
    moving = slice(0 if from_rest else changes[0], changes[-1] + 2)
    t, goal = t[moving], goal[moving]
    reference = command_reference(gait, from_rest=from_rest)
    # A periodic command is the same a period later; one that begins is not.
    span = t[-1] - t[0] if from_rest else 0.0
    shifts = np.arange(-t[0] - span, -t[0] + gait.period, gait.period / _IN_PERIOD)
    look = np.linspace(0, len(t) - 1, min(_LOOKED_AT, len(t))).astype(int)
    # A constant difference is phi's zero, not the clock's offset.
    off = np.array([np.std(goal[look] - reference(t[look] + one)[0]) for one in shifts])
    walled = np.concatenate([[np.inf], off, [np.inf]])
    lowest = np.flatnonzero((off <= walled[:-2]) & (off <= walled[2:]))
    lowest = lowest[np.argsort(off[lowest], kind="stable")][:_TRIED]
    return likely_fits(t, goal, reference, shifts[lowest].tolist())


_LOSS = 1e-3
"""Share by which phi may move less than the servo's shaft before play is suspected."""


@dataclass(frozen=True)
class Shift(ClockShift):
    """The shift to the command's clock.

    play     part of the offset, s, by which phi may lag the servo's shaft, as play or compliance
             between them makes phi move less
    applied  whether the recording was shifted: only if the offset or the drift is certain
    """

    play: float
    applied: bool

    def of(self, t: Array) -> Array:
        """The recording's times t (n,) on the command's clock, s."""
        return t + self.offset + self.drift * (t - self.t_mid)

    def __str__(self) -> str:
        low, high = self.interval()
        return (
            f"t {self.offset:+.5f} s (95 %: {low:+.5f} to {high:+.5f} s), and gains "
            f"{1e6 * self.drift:+.3g} +- {COVERED * 1e6 * self.sigma[1]:.2g} us a second"
        )


def shift_of(log: ClockFit, goal: ClockFit, period: float, *, rest: bool) -> Shift:
    """The two fits as one; the capture's time to the log's, and the log's to the command's.

    rest: the command has a beginning. Otherwise it is the same a period (s) later, and the shift
    nearest to 0 is taken.
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


_LESS, _SURE = 0.01, 3.0
_LEFT = 0.5
"""Residual share of phi's motion beyond which it is another motion than the log's."""
_ANOTHER = 0.05
"""Relative difference allowed between the goal's amplitude and the gait's."""


def log_notices(
    fit: ClockFit, goal: ClockFit | None, shift: Shift | None, others: tuple[float, ...]
) -> Iterator[Notice]:
    """fit: phi against the log; goal: its goal against the gait; others: offsets, s, as likely as
    the one taken."""
    if shift is None:
        low, high = fit.interval(0)
        drift, half = 1e6 * fit.drift, 1.96e6 * fit.sigma[1]
        yield notice("log.clock", offset=fit.offset, low=low, high=high, drift=drift, half=half)
    else:
        yield from _of_shift(shift)
    if goal is not None and abs(goal.scale - 1) > _ANOTHER:
        yield notice("log.goal", scale=goal.scale)
    if others:
        also = ", ".join(f"{other:+.3f}" for other in others[:3])
        taken = f"{'closest to zero' if shift else 'with the longest overlap'}"
        yield notice("log.offsets", others=also, taken=taken)
    if abs(fit.scale - 1) > max(_LESS, _SURE * fit.sigma[2]):
        yield notice("log.scale", scale=fit.scale)


def _of_shift(shift: Shift) -> Iterator[Notice]:
    low, high = (1e3 * end for end in shift.interval())
    size = f"{1e3 * shift.offset:+.3g} ms (95 %: {low:+.3g} to {high:+.3g} ms)"
    play = ""
    if shift.play:
        play = (
            " phi moves less than the servo's shaft. Compliance between them may delay it by up to "
            f"{1e3 * shift.play:.2g} ms, which also looks like an offset."
        )
    if shift.applied:
        drift, half = 1e6 * shift.drift, 1.96e6 * shift.sigma[1]
        yield notice("clock.shifted", shift=size, drift=drift, half=half, play=play)
    elif shift.play:
        yield notice("clock.play", shift=size, play=play)


@dataclass(frozen=True)
class Synchrony:
    """What the servo's log says about a recording's clock.

    recording  on the command's clock, if `shift` was applied
    log        phi against the log; None if they share no motion
    goal       the log's goal against the gait; None without a gait or a goal
    shift      from the recording's own clock to the command's; None if unknown
    """

    recording: Recording
    log: ClockFit | None
    goal: ClockFit | None
    shift: Shift | None
    doubts: tuple[Notice, ...]


def synchronised(
    recording: Recording, log: ServoLog, gait: Gait | None, start: Start = "running"
) -> Synchrony:
    """The recording on the command's clock, as far as the log determines it; it is not cleaned yet.

    gait: what was commanded; without it the clocks are compared, and nothing is shifted. Of equally
    likely offsets the one is taken that shifts the recording least, and of those the one that
    rests on most samples.
    """
    t, phi = recording.t, _phi(recording)
    # Compared with the goal alone, phi's offset would include the servo's lag.
    goals = (
        goal_fits(log, gait, from_rest=start == "rest")
        if gait is not None and log.present_angle is not None
        else ()
    )
    fits = against_log(t, phi, log, tuple(-one.offset for one in goals))
    # Of another motion than the log's, most is left.
    if not fits or fits[0].scale <= 0 or fits[0].residual > _LEFT * float(np.nanstd(phi)):
        return Synchrony(recording, None, None, None, (notice("log.other"),))
    period = gait.period if gait else math.nan
    pairs = [(one, two) for one in fits for two in goals or (None,)]
    shifts = [
        None if two is None else shift_of(one, two, period, rest=start == "rest")
        for one, two in pairs
    ]
    sizes = [0.0 if one is None else abs(one.offset) for one in shifts]
    nearest = [i for i, size in enumerate(sizes) if size < min(sizes) + _APART]
    best = max(nearest, key=lambda i: pairs[i][0].samples)
    (fit, goal), shift = pairs[best], shifts[best]
    others = tuple(one.offset for one in fits if one is not fit)
    if shift is not None:
        # Only a shift of less than half a period is plausible.
        far = start == "rest" and abs(shift.offset) > period / 2
        others = _apart([one.offset for one in shifts if one], shift.offset) if far else ()
    if shift is not None and shift.applied:
        recording = replace(recording, t=shift.of(t))
    notices = tuple(log_notices(fit, goal, shift, others))
    return Synchrony(_with_source(recording, log, shift), fit, goal, shift, notices)


def _apart(offsets: list[float], taken: float) -> tuple[float, ...]:
    """Offsets other than the one taken, nearest to it first, s."""
    apart = {round(one, 2): one for one in offsets if abs(one - taken) > _APART}
    return tuple(sorted(apart.values(), key=lambda one: abs(one - taken)))


def _phi(recording: Recording) -> Array:
    """phi without outliers, which would bias the clock fit."""
    phi, sigma = recording.data("phi"), recording.sigma["phi"]
    if not (np.isfinite(sigma) & (sigma > 0)).all():
        return phi
    return np.where(outliers(recording.t, phi, sigma).outlier, np.nan, phi)


def _with_source(recording: Recording, log: ServoLog, shift: Shift | None) -> Recording:
    source: dict[str, str] = {"servo log": f"{log.name}, {log.rate:.6g} Hz"}
    if shift is not None and shift.applied:
        source["clock"] = f"the command's, by the servo's log: the recording's {shift}"
    elif shift is not None:
        source["servo log"] += f"; the command's clock is the recording's {shift}: not shifted"
    return replace(recording, source=MappingProxyType({**recording.source, **source}))
